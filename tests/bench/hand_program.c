/// Phong by hand, with the arithmetic of a shader's program: doubles, eight per vector, and the highlight in float
/// with the engine's polynomials, so that both programs are right to seven digits. Everything stays in registers from
/// the first load to the store, and products and sums are fused.
#include "engine/render/stages/simd/coefficients.h"
#include "tests/bench/hand_program.h"
#include "tests/bench/options.h"
#include "tests/bench/program_points.h"
#include "tests/bench/wide.h"

typedef __m512d vd;

static inline vd load(const program_points *p, int input, int at) { return _mm512_load_pd(p->input[input] + at); }

static inline vd dot_of(const program_points *p, int a, const vd b[3], int at)
{
    return load(p, a, at) * b[0] + load(p, a + 1, at) * b[1] + load(p, a + 2, at) * b[2];
}

/// Returns r.v. *cosine gets n.l.
static inline vd reflected(const program_points *p, int at, vd *cosine)
{
    const vd n[3] = { load(p, GLINT_INPUT_N_X, at), load(p, GLINT_INPUT_N_Y, at), load(p, GLINT_INPUT_N_Z, at) };
    vd r[3];
    *cosine = dot_of(p, GLINT_INPUT_L_X, n, at);
    for (int c = 0; c < 3; c++)
        r[c] = (*cosine + *cosine) * n[c] - load(p, GLINT_INPUT_L_X + c, at);
    return dot_of(p, GLINT_INPUT_V_X, r, at);
}

static inline vf narrow(vd low, vd high)
{
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high), 1);
}

static inline vd widened(vf x, int half)
{
    return _mm512_cvtps_pd(half ? _mm512_extractf32x8_ps(x, 1) : _mm512_castps512_ps256(x));
}

static inline void store(float *to, const vd v[2])
{
    const vd zero = _mm512_setzero_pd(), most = _mm512_set1_pd(0x1p100);
    _mm512_store_ps(
        to, narrow(_mm512_min_pd(_mm512_max_pd(v[0], zero), most), _mm512_min_pd(_mm512_max_pd(v[1], zero), most)));
}

/// x^s for 0 < x <= 1 and s >= 0.
static inline vf power(vf x, vf s)
{
    static const float log2_terms[] = { GLINT_LOG2_C9, GLINT_LOG2_C8, GLINT_LOG2_C7, GLINT_LOG2_C6, GLINT_LOG2_C5,
                                        GLINT_LOG2_C4, GLINT_LOG2_C3, GLINT_LOG2_C2, GLINT_LOG2_C1, GLINT_LOG2_C0 };
    static const float exp2_terms[] = { GLINT_EXP2_D6, GLINT_EXP2_D5, GLINT_EXP2_D4, GLINT_EXP2_D3,
                                        GLINT_EXP2_D2, GLINT_EXP2_D1, GLINT_EXP2_D0 };
    const vf f = _mm512_getmant_ps(x, _MM_MANT_NORM_p75_1p5, _MM_MANT_SIGN_zero) - all(1);
    const vf e = _mm512_getexp_ps(x * all(1.3333333F));
    vf p = all(log2_terms[0]);
    for (int i = 1; i < 10; i++)
        p = p * f + all(log2_terms[i]);
    const vf y = _mm512_max_ps(s * (e + f * p), all(-100));
    const vf n = _mm512_roundscale_ps(y, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC), rest = y - n;
    p = all(exp2_terms[0]);
    for (int i = 1; i < 7; i++)
        p = p * rest + all(exp2_terms[i]);
    return _mm512_scalef_ps(p, n);
}

static void phong(program_points *p)
{
    for (int i = 0; i < PROGRAM_POINTS; i += 16) {
        vd cosine[2], angle[2];
        for (int half = 0; half < 2; half++)
            angle[half] = reflected(p, i + 8 * half, &cosine[half]);
        const vf x = narrow(angle[0], angle[1]);
        const vf s = narrow(load(p, GLINT_INPUT_SHININESS, i), load(p, GLINT_INPUT_SHININESS, i + 8));
        const vm shines = less(all(0), x);
        const vf highlight = pick(shines, power(pick(shines, x, all(1)), s), all(0));
        for (int c = 0; c < 3; c++) {
            vd diffuse[2], specular[2];
            for (int half = 0; half < 2; half++) {
                const vd light = load(p, GLINT_INPUT_LIGHT_R + c, i + 8 * half);
                diffuse[half] = load(p, GLINT_INPUT_KD_R + c, i + 8 * half) * light * cosine[half];
                specular[half] = load(p, GLINT_INPUT_KS_R + c, i + 8 * half) * light * widened(highlight, half);
            }
            store(p->plane[c] + i, diffuse);
            store(p->plane[3 + c] + i, specular);
        }
    }
}

static double time_points(void *state)
{
    const double start = bench_now_ms();
    for (int i = 0; i < PROGRAM_REPEATS; i++) {
        phong(state);
        __asm__ volatile("" ::: "memory"); // keeps the compiler from reusing results between rounds
    }
    return bench_now_ms() - start;
}

void hand_run_program(void)
{
    static program_points points;
    program_points_fill(&points);
    bench_say("phong", "ns", bench_median(time_points, &points) * 1e6 / ((double)PROGRAM_REPEATS * PROGRAM_POINTS));
}
