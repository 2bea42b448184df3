/// The engine's allowed error: 4 ulp of t, times the magnification of the inputs' rounding. Half an ulp of the
/// direction, of the radius, and of o - c where that is not exact, moves the hit by so much that a more precise
/// answer would be meaningless. (Where o - c is exact, the roundings of o and c do not count:
/// a user may mean these values.)
#ifndef HARD_JUDGE_H
#define HARD_JUDGE_H

#include "engine/glint.h"
#include "engine/glint_inspect.h"
#include "tests/hard/oracle/oracle.h"

typedef enum verdict {
    RIGHT,
    TOO_CLOSE, ///< the ray is within 8 * 2^-53 of tangency, or of the surface where o - c is not exact: either answer
        ///< is accepted
    WRONG_DECISION,
    WRONG_T,
    WRONG_NORMAL
} verdict;

#define TANGENCY (8 * 0x1p-53) ///< largest distance from tangency, in units of |f| + r, at which the engine may
    ///< decide wrongly
#define SURFACE (2 * 0x1p-53) ///< rounding error of an inexact o - c, in the same units

extern const char *const verdict_name[];

typedef struct judgement {
    verdict verdict;
    double ulp; ///< error of t, in ulp
    double t_share; ///< error of t relative to the allowed error, which is 4 ulp times the magnification of the
        ///< inputs' rounding
    double normal_share;
} judgement;

double ulp_of(double x);
judgement judge_sphere(const hard_ray *ray, const hard_sphere *sphere, const truth *want, bool hit,
                       const glint_hit *got);
judgement judge_plane(const hard_ray *ray, const hard_plane *plane, const truth *want, bool hit, const glint_hit *got);

#endif
