/// The pass `outline`: 1 where a line is drawn, otherwise 0; computed from the finished planes depth, normal and
/// object_id.
///
/// There is an edge between two adjacent pixels if one hits nothing, if they show different objects, or if no single
/// smooth surface contains both their points P, Q with their normals m, n. With e = (Q - P) / |Q - P|: on an arc, e.m
/// and -e.n are the sine of half the angle between the normals. If the larger of e.m and -e.n is positive, the
/// surface bends towards the eye, or one point hides in front of the other: an edge above VALLEY. If it
/// is negative, the surface bends away: an edge above RIDGE, as smaller values could also be a small
/// ball. If m.n is above SMOOTH, the surface may be a mesh whose interpolated normals are far from the
/// geometric ones, and STEP is needed: one surface behind the other. The line is one pixel wide, on the
/// nearer side.
#include "engine/base/vec.h"
#include "engine/render/frame/renderer.h"

#define VALLEY 0.25 ///< sine of half of 29 degrees
#define RIDGE 0.45 ///< sine of half of 53 degrees
#define SMOOTH 0.95 ///< cosine of 18 degrees
#define STEP 0.7 ///< sine of 44 degrees

typedef struct outliner {
    const glint_plan *plan;
    glint_extent extent;
    glint_image *image;
    double offset[2]; ///< position in a pixel: the centres, for which the planes are computed
} outliner;

/// The object, point and normal of a pixel.
typedef struct point {
    size_t at;
    double depth, position[3], normal[3]; ///< position: from the eye
} point;

static point point_at(const outliner *o, int x, int y)
{
    const glint_plan_camera *camera = &o->plan->camera;
    const glint_image *image = o->image;
    const double sx = 2 * (x + o->offset[0]) - camera->span[0], sy = camera->span[1] - 2 * (y + o->offset[1]);
    point p = { .at = (size_t)y * (size_t)image->width + (size_t)x };
    double aside[3], direction[3];
    p.depth = (double)image->plane[GLINT_PASS_DEPTH][0][p.at];
    for (int c = 0; c < 3; c++) {
        aside[c] = sx * camera->right[c] + sy * camera->up[c];
        direction[c] = camera->forward[c] + (camera->orthographic ? 0 : aside[c]);
        p.normal[c] = (double)image->plane[GLINT_PASS_NORMAL][c][p.at];
    }
    const double scale = p.depth / sqrt(vec_dot(direction, direction));
    for (int c = 0; c < 3; c++)
        p.position[c] = scale * direction[c] + (camera->orthographic ? aside[c] : 0);
    return p;
}

static bool is_hit(const point *p) { return p->depth < HUGE_VAL; }

/// Returns whether no smooth surface passes through both points.
static bool is_break(const point *p, const point *q)
{
    double e[3];
    vec_sub(e, q->position, p->position);
    const double length = sqrt(vec_dot(e, e));
    const double up = vec_dot(e, p->normal), down = -vec_dot(e, q->normal);
    if (vec_dot(p->normal, q->normal) > SMOOTH)
        return fmax(up, down) > STEP * length;
    return fmax(up, down) > VALLEY * length || fmin(up, down) < -RIDGE * length;
}

/// Returns whether the pixel p, a hit, gets a line because of an edge between p and the pixel at x, y.
static bool draws(const outliner *o, const point *p, int x, int y)
{
    const glint_extent *e = &o->extent;
    if (x < e->x || y < e->y || x >= e->x + e->width || y >= e->y + e->height)
        return false;
    const point q = point_at(o, x, y);
    const float *id = o->image->plane[GLINT_PASS_OBJECT_ID][0];
    if (!is_hit(&q))
        return true;
    if (p->depth > q.depth || (p->depth == q.depth && p->at > q.at))
        return false;
    return id[p->at] != id[q.at] || is_break(p, &q);
}

static void draw_row(void *context, size_t index, int worker)
{
    const outliner *o = context;
    const int y = o->extent.y + (int)index;
    float *line = o->image->plane[GLINT_PASS_OUTLINE][0] + (size_t)y * (size_t)o->image->width;
    (void)worker;
    for (int x = o->extent.x; x < o->extent.x + o->extent.width; x++) {
        const point p = point_at(o, x, y);
        line[x] = is_hit(&p) && (draws(o, &p, x + 1, y) || draws(o, &p, x, y + 1) || draws(o, &p, x - 1, y) ||
                                 draws(o, &p, x, y - 1));
    }
}

static void finish(glint_renderer *renderer, const glint_tile_frame *frame, const glint_extent *extent)
{
    outliner o = { .plan = frame->plan, .extent = *extent, .image = frame->image };
    glint_plan_centre_offset(frame->plan, o.offset);
    glint_pool_run(renderer->pool, (size_t)extent->height, draw_row, &o);
}

static bool called(const glint_plan *plan) { return plan->desc.passes >> GLINT_PASS_OUTLINE & 1; }

static glint_key own_key(const glint_plan *plan, glint_key key)
{
    GLINT_KEY_ADD(key, plan->desc.outline);
    return key;
}

/// The lines drawn over beauty are found at the pixels' centres.
static glint_key pass_key(const glint_plan *plan, int pass, glint_key key)
{
    if (pass != GLINT_PASS_BEAUTY || !plan->desc.outline)
        return key;
    key = own_key(plan, key);
    return glint_plan_casts_centres(plan) ? glint_key_add_string(key, "centres") : key;
}

/// Runs on the whole picture after its tiles.
const glint_stage glint_stage_outline = {
    .name = "outline",
    .doc = "lines where depth, normal or object changes",
    .called = called,
    .own = own_key,
    .pass_key = pass_key,
    .passes = true,
    .finish = finish,
};
