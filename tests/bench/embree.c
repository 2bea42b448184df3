/// Embree 3, used for speed: packets of sixteen rays, and for spheres user geometry with our own AVX-512 kernel of
/// one sphere against sixteen rays, which is several times faster than Embree's native spheres. Meshes are Embree's
/// native triangles. Shading, samples and bands are as in the hand-written program. Its callbacks omit some cases (a
/// ray that starts inside a sphere, normals of hits that are later occluded), which is in Embree's favour.
///
///   embree frame scene=NAME [threads=N] [samples=N] [shadows=0] [area=1]    ms: build, render
///   embree picture out=FILE scene=...
#include <embree3/rtcore.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/bench/packet_light.h"
#include "tests/bench/picture.h"

#define FAR 1e30F
#define NEAR 1e-3F

typedef struct embree_scene {
    RTCDevice device;
    RTCScene scene;
    const bench_scene *plain;
    enum RTCIntersectContextFlags flags;
} embree_scene;

/// The flags that are faster for each scene, as measured:
/// with only five spheres, the flag for coherent packets is slower.
static enum RTCIntersectContextFlags best_flags(const bench_scene *plain)
{
    bool few = plain->sphere_count > 0 && plain->sphere_count < 100;
    return few ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
}

// ---- One sphere against up to sixteen rays ----

/// The arrays of a packet of n rays are consecutive, in the order of struct RTCRay and then RTCHit.
enum ray_field { ORG_X, ORG_Y, ORG_Z, T_NEAR, DIR_X, DIR_Y, DIR_Z, TIME, T_FAR, HIT_PRIM = 17, HIT_GEOM = 18 };

typedef struct sphere_test {
    vm hits;
    vf t;
} sphere_test;

static inline sphere_test test_sphere(const float *sphere, const int *valid, const float *rays, unsigned n)
{
    vm lanes = (vm)((1U << n) - 1);
    lanes = _mm512_mask_test_epi32_mask(lanes, _mm512_maskz_loadu_epi32(lanes, valid), _mm512_set1_epi32(-1));
#define RAYS(field) _mm512_maskz_loadu_ps(lanes, rays + (field)*n)
    vec dir = { RAYS(DIR_X), RAYS(DIR_Y), RAYS(DIR_Z) };
    vec to = { all(sphere[0]) - RAYS(ORG_X), all(sphere[1]) - RAYS(ORG_Y), all(sphere[2]) - RAYS(ORG_Z) };
    vf along = dot(to, dir);
    vec off = add_scaled(to, dir, all(0) - along);
    vf square = all(sphere[3] * sphere[3]) - dot(off, off);
    sphere_test test = { .hits = _mm512_mask_cmp_ps_mask(lanes, square, all(0), _CMP_GT_OQ) };
    if (test.hits) {
        test.t = along - _mm512_maskz_sqrt_ps(test.hits, square);
        test.hits &= less(RAYS(T_NEAR), test.t) & less(test.t, RAYS(T_FAR));
    }
#undef RAYS
    return test;
}

static void sphere_bounds(const struct RTCBoundsFunctionArguments *a)
{
    const embree_scene *e = a->geometryUserPtr;
    const float *p = e->plain->spheres + 4 * (size_t)a->primID;
    *a->bounds_o = (struct RTCBounds) { .lower_x = p[0] - p[3],
                                        .lower_y = p[1] - p[3],
                                        .lower_z = p[2] - p[3],
                                        .upper_x = p[0] + p[3],
                                        .upper_y = p[1] + p[3],
                                        .upper_z = p[2] + p[3] };
}

static void sphere_intersect(const struct RTCIntersectFunctionNArguments *a)
{
    const embree_scene *e = a->geometryUserPtr;
    float *rays = (float *)a->rayhit;
    sphere_test test = test_sphere(e->plain->spheres + 4 * (size_t)a->primID, a->valid, rays, a->N);
    if (!test.hits)
        return;
    _mm512_mask_storeu_ps(rays + T_FAR * a->N, test.hits, test.t);
    _mm512_mask_storeu_epi32(rays + HIT_PRIM * a->N, test.hits, _mm512_set1_epi32((int)a->primID));
    _mm512_mask_storeu_epi32(rays + HIT_GEOM * a->N, test.hits, _mm512_set1_epi32((int)a->geomID));
}

static void sphere_occluded(const struct RTCOccludedFunctionNArguments *a)
{
    const embree_scene *e = a->geometryUserPtr;
    float *rays = (float *)a->ray;
    sphere_test test = test_sphere(e->plain->spheres + 4 * (size_t)a->primID, a->valid, rays, a->N);
    const vi minus_infinity = _mm512_set1_epi32((int)0xff800000U);
    _mm512_mask_storeu_epi32(rays + T_FAR * a->N, test.hits, minus_infinity);
}

// ---- Packets ----

static inline void start(struct RTCRay16 *ray, vec origin, vec dir, vf near, vf far)
{
    _mm512_store_ps(ray->org_x, origin.x);
    _mm512_store_ps(ray->org_y, origin.y);
    _mm512_store_ps(ray->org_z, origin.z);
    _mm512_store_ps(ray->tnear, near);
    _mm512_store_ps(ray->dir_x, dir.x);
    _mm512_store_ps(ray->dir_y, dir.y);
    _mm512_store_ps(ray->dir_z, dir.z);
    _mm512_store_ps(ray->time, all(0));
    _mm512_store_ps(ray->tfar, far);
    _mm512_store_si512(ray->mask, _mm512_set1_epi32(-1));
    _mm512_store_si512(ray->flags, _mm512_setzero_si512());
}

static inline struct RTCIntersectContext context_of(const embree_scene *e)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = e->flags;
    return context;
}

static inline vec unit(vec v) { return scaled(v, inverse_sqrt(dot(v, v))); }

static inline packet_hit trace(const packet_scene *s, vec dir)
{
    const embree_scene *e = s->side;
    static const int valid[16]
        __attribute__((aligned(64))) = { -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1 };
    struct RTCRayHit16 rays;
    struct RTCIntersectContext context = context_of(e);
    start(&rays.ray, s->eye, dir, all(0), all(FAR));
    _mm512_store_si512(rays.hit.geomID, _mm512_set1_epi32(-1));
    rtcIntersect16(valid, e->scene, &context, &rays);

    packet_hit hit = { .mask = _mm512_cmpneq_epi32_mask(_mm512_load_si512(rays.hit.geomID), _mm512_set1_epi32(-1)) };
    hit.point = add_scaled(s->eye, dir, _mm512_load_ps(rays.ray.tfar));
    hit.material = _mm512_setzero_si512();
    if (s->plain.triangle_count) {
        vec normal =
            unit((vec) { _mm512_load_ps(rays.hit.Ng_x), _mm512_load_ps(rays.hit.Ng_y), _mm512_load_ps(rays.hit.Ng_z) });
        hit.normal = scaled(normal, pick(less(all(0), dot(normal, dir)), all(-1), all(1)));
        return hit;
    }
    vi id = _mm512_load_si512(rays.hit.primID), at = _mm512_slli_epi32(id, 2);
    const float *spheres = s->plain.spheres;
    vec center = { _mm512_mask_i32gather_ps(all(0), hit.mask, at, spheres, 4),
                   _mm512_mask_i32gather_ps(all(0), hit.mask, at, spheres + 1, 4),
                   _mm512_mask_i32gather_ps(all(0), hit.mask, at, spheres + 2, 4) };
    hit.material = _mm512_mask_i32gather_epi32(hit.material, hit.mask, id, s->plain.sphere_material, 4);
    hit.normal = unit(minus(hit.point, center));
    return hit;
}

static inline vm hidden(const packet_scene *s, vec point, vec l, vf distance, vm mask)
{
    const embree_scene *e = s->side;
    int valid[16] __attribute__((aligned(64)));
    struct RTCRay16 rays;
    struct RTCIntersectContext context = context_of(e);
    _mm512_store_si512(valid, _mm512_movm_epi32(mask));
    start(&rays, point, l, all(NEAR), distance);
    rtcOccluded16(valid, e->scene, &context, &rays);
    return mask & less(_mm512_load_ps(rays.tfar), all(0));
}

// ---- Build ----

static RTCGeometry make_spheres(embree_scene *e)
{
    RTCGeometry geometry = rtcNewGeometry(e->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)e->plain->sphere_count);
    rtcSetGeometryUserData(geometry, e);
    rtcSetGeometryBoundsFunction(geometry, sphere_bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, sphere_intersect);
    rtcSetGeometryOccludedFunction(geometry, sphere_occluded);
    return geometry;
}

static RTCGeometry make_mesh(embree_scene *e)
{
    const bench_scene *p = e->plain;
    RTCGeometry geometry = rtcNewGeometry(e->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, p->vertex_count),
           p->vertices, 12 * p->vertex_count);
    memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, p->triangle_count),
           p->triangles, 12 * p->triangle_count);
    return geometry;
}

static double time_build(void *side)
{
    embree_scene *e = side;
    double begin = bench_now_ms();
    if (e->scene)
        rtcReleaseScene(e->scene);
    e->scene = rtcNewScene(e->device);
    RTCGeometry geometry = e->plain->triangle_count ? make_mesh(e) : make_spheres(e);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(e->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(e->scene);
    if (rtcGetDeviceError(e->device) != RTC_ERROR_NONE)
        bench_fail("embree", "the scene cannot be built");
    return bench_now_ms() - begin;
}

static double time_render(void *scene)
{
    double begin = bench_now_ms();
    packet_frame(scene, render_band, NULL, NULL);
    return bench_now_ms() - begin;
}

static void write_picture(const packet_scene *s)
{
    static picture codes;
    picture_writer *writer = picture_writer_create();
    size_t size;
    packet_frame(s, render_band, picture_tone, &codes);
    const uint8_t *bytes = picture_encode(writer, &codes, &size);
    picture_write(bytes, size, s->options.out);
    picture_writer_destroy(writer);
}

int main(int argc, char **argv)
{
    bench_options options = bench_options_read(argc, argv);
    static packet_scene scene;
    packet_scene_init(&scene, &options);
    char config[32];
    snprintf(config, sizeof config, "threads=%d", options.threads);
    embree_scene e = { .device = rtcNewDevice(config), .plain = &scene.plain, .flags = best_flags(&scene.plain) };
    if (!e.device)
        bench_fail("embree", "no device");
    scene.side = &e;
    if (strcmp(options.mode, "frame") == 0) {
        bench_say("build", "ms", bench_median(time_build, &e));
        bench_say_render(time_render, &scene);
    } else if (strcmp(options.mode, "picture") == 0 && options.out) {
        time_build(&e);
        write_picture(&scene);
    } else {
        bench_fail(options.mode, "frame or picture out=FILE expected");
    }
    rtcReleaseScene(e.scene);
    rtcReleaseDevice(e.device);
    packet_scene_free(&scene);
    return 0;
}
