/// The derivative of a hit: the point stays on its ray and on its surface while the surface or the viewer moves.
#include "engine/base/vec.h"
#include "engine/render/effects/derivative/work.h"

/// Computes the slope of the vector from a pinhole's eye to a hit as the view turns, at constant distance.
static void turn_direction(const glint_plan *plan, const glint_derivative_view *view, const double direction[3],
                           double out[3])
{
    const glint_plan_camera *c = &plan->camera;
    const double along = vec_dot(direction, c->forward),
                 across = vec_dot(direction, c->right) / vec_dot(c->right, c->right),
                 down = vec_dot(direction, c->up) / vec_dot(c->up, c->up);
    for (int i = 0; i < 3; i++)
        out[i] = (along * view->forward[i] + across * view->right[i]) + down * view->up[i];
}

/// A hit and its motion.
typedef struct bent_hit {
    double point[3], normal[3], direction[3]; ///< direction: along the ray, of any length
    double carried[3]; ///< slope of the point at constant distance along the ray
} bent_hit;

// ---- Normals of curved surfaces -------------------------------------------------------------------------------------

/// Computes the slope of a normalised vector. length, change: length and slope of the vector before normalisation.
static void turn_unit(const double unit[3], double length, const double change[3], double out[3])
{
    const double along = vec_dot(unit, change);
    for (int c = 0; c < 3; c++)
        out[c] = (change[c] - along * unit[c]) / length;
}

/// Computes half the gradient of the unit shape's implicit function on a curved surface, and its slope along
/// `direction`. Returns false on a flat face. `turn`: along the normal, in the space of the unit shape.
static bool find_gradient(const glint_solid *solid, const double k[3], const double turn[3], const double direction[3],
                          double gradient[3], double change[3])
{
    const double across = turn[0] * turn[0] + turn[1] * turn[1], along = turn[2] * turn[2];
    const bool cone = solid->form == GLINT_FORM_CONE || solid->form == GLINT_FORM_FUNNEL;
    const bool tube = solid->form == GLINT_FORM_CYLINDER || solid->form == GLINT_FORM_TUBE;
    const double z = cone ? -1 : tube ? 0 : 1;
    if (solid->form == GLINT_FORM_BOX || solid->form == GLINT_FORM_DISK || ((cone || tube) && 2 * across < along))
        return false;
    double share = 1, share_slope = 0;
    if (solid->form == GLINT_FORM_TORUS) {
        const double round = sqrt(k[0] * k[0] + k[1] * k[1]);
        share = 1 - 1 / round;
        share_slope = (k[0] * direction[0] + k[1] * direction[1]) / (round * round * round);
    }
    for (int c = 0; c < 3; c++) {
        gradient[c] = c < 2 ? share * k[c] : z * k[c];
        change[c] = c < 2 ? share * direction[c] + share_slope * k[c] : z * direction[c];
    }
    return true;
}

/// Computes the slope of the normal. `moved`: the slope of the point. A part that moves is a sphere.
static void curve_solid(const glint_solid *solid, const glint_prim *prim, const glint_derivative_part *part,
                        const bent_hit *hit, const double moved[3], double out[3])
{
    double k[3], turn[3], direction[3], gradient[3], change[3], normal[3] = { 0 }, turned[3] = { 0 }, from[3],
                                                                within[3];
    vec_sub(from, hit->point, prim->center);
    for (int c = 0; c < 3; c++) // relative to the moving sphere
        within[c] = (moved[c] - part->position[c]) - from[c] * part->growth;
    for (int c = 0; c < 3; c++) {
        const double column[3] = { solid->forward[0][c], solid->forward[1][c], solid->forward[2][c] };
        k[c] = vec_dot(solid->inverse[c], from);
        direction[c] = vec_dot(solid->inverse[c], within);
        turn[c] = vec_dot(column, hit->normal);
    }
    if (!find_gradient(solid, k, turn, direction, gradient, change))
        return;
    for (int c = 0; c < 9; c++) {
        normal[c % 3] += solid->inverse[c / 3][c % 3] * gradient[c / 3];
        turned[c % 3] += solid->inverse[c / 3][c % 3] * change[c / 3];
    }
    turn_unit(hit->normal, vec_dot(normal, hit->normal), turned, out);
}

/// Computes the weights of glint_bend_shares. f, g: the sides from the first corner; gradient: their cross product.
static void find_shares_of(const double f[3], const double g[3], const double gradient[3], const double at[3], double out[3])
{
    const double size = vec_dot(gradient, gradient);
    double x[3];
    vec_cross(x, at, g);
    out[1] = vec_dot(x, gradient) / size;
    vec_cross(x, f, at);
    out[2] = vec_dot(x, gradient) / size;
    out[0] = -(out[1] + out[2]);
}

static void find_shares(const glint_prim *prim, const double gradient[3], const double at[3], double out[3])
{
    double f[3], g[3];
    vec_sub(f, prim->corner[1], prim->corner[0]);
    vec_sub(g, prim->corner[2], prim->corner[0]);
    find_shares_of(f, g, gradient, at, out);
}

void glint_bend_shares(double scale, const glint_prim *prim, const double at[3], double out[3])
{
    double f[3], g[3], gradient[3], scaled[3];
    vec_sub(f, prim->corner[1], prim->corner[0]);
    vec_sub(g, prim->corner[2], prim->corner[0]);
    vec_scale(f, f, scale);
    vec_scale(g, g, scale);
    vec_scale(scaled, at, scale);
    vec_cross(gradient, f, g);
    find_shares_of(f, g, gradient, scaled, out);
}

/// Computes the slope of the interpolated normal of a smooth triangle.
static void curve_triangle(const glint_corner_normals *corners, const glint_prim *prim, const double gradient[3],
                           const bent_hit *hit, const double moved[3], double out[3])
{
    double from[3], share[3], change[3], normal[3] = { 0 }, turned[3] = { 0 };
    vec_sub(from, hit->point, prim->corner[0]);
    find_shares(prim, gradient, from, share);
    find_shares(prim, gradient, moved, change);
    share[0] += 1;
    for (int j = 0; j < 9; j++) {
        normal[j % 3] += share[j / 3] * corners->normal[j / 3][j % 3];
        turned[j % 3] += change[j / 3] * corners->normal[j / 3][j % 3];
    }
    const double length = vec_dot(normal, hit->normal);
    if (length != 0) // otherwise it is the normal of the face
        turn_unit(hit->normal, length, turned, out);
}

// ---- A hit --------------------------------------------------------------------------------------------------------

/// Computes a vector perpendicular to the surface, of any length.
static void find_across(const bent_hit *hit, const glint_prim *prim, double out[3])
{
    double f[3], g[3];
    if (prim->kind == GLINT_PRIM_SPHERE) {
        vec_sub(out, hit->point, prim->center);
    } else if (prim->kind == GLINT_PRIM_PLANE) {
        vec_copy(out, prim->normal);
    } else if (prim->kind == GLINT_PRIM_TRIANGLE) {
        vec_sub(f, prim->corner[1], prim->corner[0]);
        vec_sub(g, prim->corner[2], prim->corner[0]);
        vec_cross(out, f, g);
    } else {
        vec_copy(out, hit->normal);
    }
}

/// Computes the slopes of point and normal. The point stays on the tangent plane, which moves with the surface.
static void hold(const bent_hit *hit, const glint_geometry_table *table, const glint_prim *prim,
                 const glint_derivative_part *part, glint_bend *out)
{
    const bool has_center = prim->kind != GLINT_PRIM_TRIANGLE;
    double gradient[3], off[3], rest = 0;
    find_across(hit, prim, gradient);
    for (int c = 0; c < 3; c++) {
        off[c] = has_center ? hit->point[c] - prim->center[c] : 0;
        rest += gradient[c] * ((part->position[c] - hit->carried[c]) + part->growth * off[c]);
        rest -= part->normal[c] * (hit->point[c] - part->pivot[c]);
    }
    const double further = rest / vec_dot(gradient, hit->direction), side = vec_dot(gradient, hit->normal) < 0 ? -1 : 1;
    for (int c = 0; c < 3; c++) {
        out->point[c] = hit->carried[c] + further * hit->direction[c];
        out->normal[c] = side * part->normal[c];
    }
    for (int c = 0; c < 3 && prim->kind == GLINT_PRIM_SPHERE; c++)
        out->normal[c] = ((out->point[c] - part->position[c]) - off[c] * part->growth) * (side / prim->radius);
    if (prim->kind == GLINT_PRIM_SOLID)
        curve_solid(&table->solids[prim->item], prim, part, hit, out->point, out->normal);
    else if (prim->kind == GLINT_PRIM_TRIANGLE && table->corner_normals && prim->item != GLINT_MISS)
        curve_triangle(&table->corner_normals[prim->item], prim, gradient, hit, out->point, out->normal);
}

/// Computes the position of a sample in the picture, in half pixels from the middle: to the right and up. See the
/// stage camera.
static void find_screen_position(const glint_tile *tile, uint32_t i, double out[2])
{
    const glint_camera_args *c = &tile->camera;
    const uint32_t group = i / GLINT_GROUP, lane = i % GLINT_GROUP;
    out[0] = 2 * (c->x0 + 4 * (group % c->groups_across) + lane % 4 + c->offset[0]) - c->width;
    out[1] = c->height - 2 * (c->y0 + 4 * (group / c->groups_across) + lane / 4 + c->offset[1]);
}

/// Computes the position of a ray on the lens, and its slope.
static void find_lens(const glint_tile *tile, const glint_plan *plan, const glint_derivative_view *view, uint32_t lane,
                      double at[3], double slope[3])
{
    for (int c = 0; c < 3 && plan->lens; c++) {
        const glint_lens_points *points = &plan->lens[tile->sample];
        at[c] = tile->lens.shift[c][lane];
        slope[c] = view->wider * at[c] + (points->at[0][lane] * view->lens[0][c] + points->at[1][lane] * view->lens[1][c]);
    }
}

/// Computes the ray of a sample, from `from` along `direction`, with the slopes of both, for orthographic cameras and
/// lenses.
static void aim(const glint_tile *tile, const glint_plan *plan, const glint_derivative_view *view, uint32_t i, double from[3],
                double direction[3], double moved[3], double turned[3])
{
    const glint_plan_camera *camera = &plan->camera;
    const double near = plan->lens ? 1 / camera->focus : 0;
    double screen[2], at[3] = { 0 }, slope[3] = { 0 };
    find_screen_position(tile, i, screen);
    find_lens(tile, plan, view, i % GLINT_GROUP, at, slope);
    for (int c = 0; c < 3; c++) {
        const double across = screen[0] * camera->right[c] + screen[1] * camera->up[c];
        const double changed = screen[0] * view->right[c] + screen[1] * view->up[c];
        from[c] = camera->eye[c] + ((camera->orthographic ? across : 0) + at[c]);
        moved[c] = view->eye[c] + ((camera->orthographic ? changed : 0) + slope[c]);
        direction[c] = camera->forward[c] + ((camera->orthographic ? 0 : across) - at[c] * near);
        turned[c] = view->forward[c] + ((camera->orthographic ? 0 : changed) - (slope[c] * near + at[c] * view->nearer));
    }
}

/// Computes the slopes of a hit seen by the eye.
static void bend_view(const glint_tile *tile, const glint_plan *plan, const glint_derivative_view *view, uint32_t i,
                      const double eye[3], bent_hit *hit, glint_bend *out)
{
    double from[3], turned[3], far = 1;
    if (view->moves && (plan->lens || plan->camera.orthographic)) {
        double seen[3];
        aim(tile, plan, view, i, from, hit->direction, out->from, turned);
        vec_sub(seen, hit->point, from);
        far = vec_dot(seen, hit->direction) / vec_dot(hit->direction, hit->direction);
    } else {
        for (int c = 0; c < 3; c++)
            hit->direction[c] = view->moves ? hit->point[c] - plan->camera.eye[c] : -eye[c];
        turn_direction(plan, view, hit->direction, turned);
        vec_copy(out->from, view->eye);
    }
    const double shorter = 1 / sqrt(vec_dot(hit->direction, hit->direction)), away = vec_dot(turned, eye);
    for (int c = 0; c < 3; c++) {
        hit->carried[c] = out->from[c] + far * turned[c];
        out->eye[c] = (away * eye[c] - turned[c]) * shorter;
    }
}

/// Computes the slopes of a hit seen by a ray that left a surface. Returns false if the ray does not move the hit.
static bool bend_ray(const glint_batch *batch, const glint_plan *plan, size_t index, uint32_t i, const double eye[3],
                     bent_hit *hit, glint_bend *out)
{
    const uint32_t ray = batch->ray_of[i];
    const glint_ray_slope *slope = &batch->rays->slopes[ray * plan->derivatives->count + index];
    bool moves = false;
    double far = 0;
    for (int c = 0; c < 3; c++) {
        far -= (hit->point[c] - glint_real_at(batch->rays->origin[c], plan->desc.precision, ray)) * eye[c];
        moves = moves || slope->origin[c] != 0 || slope->direction[c] != 0;
    }
    for (int c = 0; c < 3; c++) {
        hit->direction[c] = -eye[c];
        out->from[c] = slope->origin[c];
        hit->carried[c] = slope->origin[c] + far * slope->direction[c];
        out->eye[c] = -slope->direction[c];
    }
    return moves;
}

/// Computes the slopes of a face or vertex, which does not move, for a moving eye.
static bool bend_shading_point(const glint_plan *plan, const glint_derivative_view *view, const double point[3],
                               const double eye[3], glint_bend *out)
{
    double direction[3];
    vec_sub(direction, plan->camera.eye, point);
    const double length = sqrt(vec_dot(direction, direction)), along = vec_dot(view->eye, eye);
    *out = (glint_bend) { .point = { 0 } };
    for (int c = 0; c < 3; c++) // see view_of in effects/vertex_shading/vertex.c
        out->eye[c] = plan->camera.orthographic || !(length > 0) ? -view->forward[c] : (view->eye[c] - along * eye[c]) / length;
    return view->moves;
}

bool glint_bend_sample(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t i,
                       const glint_derivative_points *points, glint_bend *out)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_derivative *d = &plan->derivatives->of[index];
    const glint_prim *prim = &frame->geometry.prims[tile->at.prim[i]];
    const glint_derivative_part *part = &d->parts[plan->geometry->prim_part[prim->id]];
    bent_hit hit;
    double eye[3];
    if (!tile->batch && !part->moves && !d->view.moves)
        return false;
    for (int c = 0; c < 3; c++) {
        hit.point[c] = points->point[c][i % GLINT_GROUP];
        hit.normal[c] = points->normal[c][i % GLINT_GROUP];
        eye[c] = points->eye[c][i % GLINT_GROUP];
    }
    if (glint_derives_shading_points(tile))
        return bend_shading_point(plan, &d->view, hit.point, eye, out);
    if (!tile->batch)
        bend_view(tile, plan, &d->view, i, eye, &hit, out);
    else if (!bend_ray(tile->batch, plan, index, i, eye, &hit, out) && !part->moves)
        return false;
    hold(&hit, &frame->geometry, prim, part, out);
    return true;
}

// ---- Hits of a group on one sphere or plane: as above, lanes side by side -----------------------------------------

void glint_bend_aim(const glint_tile *tile, const glint_plan *plan)
{
    const glint_plan_camera *c = &plan->camera;
    const double across = 1 / vec_dot(c->right, c->right), down = 1 / vec_dot(c->up, c->up);
    for (size_t k = 0; k < plan->derivatives->count; k++) {
        const glint_derivative_view *view = &plan->derivatives->of[k].view;
        glint_bend_camera *out = &glint_derivative_of(tile)->camera[k];
        out->near = plan->lens ? 1 / c->focus : 0;
        out->orthographic = c->orthographic;
        vec_copy(out->eye, c->eye);
        vec_copy(out->forward, c->forward);
        vec_copy(out->right, c->right);
        vec_copy(out->up, c->up);
        for (int i = 0; i < 9; i++)
            out->turn[i / 3][i % 3] = (view->forward[i / 3] * c->forward[i % 3] + view->right[i / 3] * (c->right[i % 3] * across)) +
                                      view->up[i / 3] * (c->up[i % 3] * down);
    }
}

/// The input of the kernel for hits on one sphere or plane.
typedef struct bend_buffers {
    glint_bend_args args;
    _Alignas(64) double screen[2][GLINT_GROUP], shift[3][GLINT_GROUP], shift_slope[3][GLINT_GROUP];
} bend_buffers;

/// Computes the positions of a group's samples in the picture and on the lens.
static void find_screen_positions(const glint_tile *tile, const glint_plan *plan, const glint_derivative_view *view,
                                  uint32_t g, bend_buffers *out)
{
    for (uint32_t i = 0; i < GLINT_GROUP; i++) {
        double middle[2], lens[3] = { 0 }, change[3] = { 0 };
        find_screen_position(tile, g * GLINT_GROUP + i, middle);
        find_lens(tile, plan, view, i, lens, change);
        for (int c = 0; c < 3; c++) {
            out->screen[c % 2][i] = middle[c % 2];
            out->shift[c][i] = lens[c];
            out->shift_slope[c][i] = change[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        out->args.screen[c % 2] = out->screen[c % 2];
        out->args.shift[c] = out->shift[c];
        out->args.shift_slope[c] = out->shift_slope[c];
    }
}

/// Copies the given lanes.
static void put_lanes(unsigned lanes, double (*from)[GLINT_GROUP], double *const to[9])
{
    for (unsigned bits = lanes; bits; bits &= bits - 1)
        for (int k = 0; k < 9; k++)
            to[k][__builtin_ctz(bits)] = from[k][__builtin_ctz(bits)];
}

/// Bends the lanes one by one.
static unsigned bend_each(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t g, unsigned lanes,
                          const glint_derivative_points *points, double *const slope[9])
{
    unsigned bent = 0;
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const unsigned i = (unsigned)__builtin_ctz(rest);
        glint_bend own;
        if (!glint_bend_sample(tile, frame, index, g * GLINT_GROUP + i, points, &own))
            continue;
        bent |= 1u << i;
        for (int c = 0; c < 3; c++) {
            slope[c][i] = own.point[c];
            slope[3 + c][i] = own.normal[c];
            slope[6 + c][i] = own.eye[c];
        }
    }
    return bent;
}

/// Prepares the lanes that hit the same primitive as the first of `lanes`, and returns them. *moves: whether their
/// hits move; *seen: whether the kernel bends the hits; otherwise they are bent one by one.
static unsigned begin(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t g, unsigned lanes,
                      const glint_derivative_points *points, bend_buffers *out, bool *seen, bool *moves)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_derivative *d = &plan->derivatives->of[index];
    const uint32_t *prims = tile->at.prim + (size_t)g * GLINT_GROUP;
    *seen = *moves = false;
    if (tile->batch || glint_derives_shading_points(tile)) {
        *moves = true;
        return lanes;
    }
    const glint_prim *prim = &frame->geometry.prims[prims[__builtin_ctz(lanes)]];
    const glint_derivative_part *part = &d->parts[plan->geometry->prim_part[prim->id]];
    *moves = d->view.moves || part->moves;
    *seen = prim->kind == GLINT_PRIM_SPHERE || prim->kind == GLINT_PRIM_PLANE;
    if (*moves && *seen) {
        out->args.points = points;
        out->args.prim = prim;
        out->args.part = part;
        out->args.view = &d->view;
        out->args.camera = &glint_derivative_of(tile)->camera[index];
        out->args.screen[0] = NULL;
        if (d->view.moves && (plan->lens || plan->camera.orthographic))
            find_screen_positions(tile, plan, &d->view, g, out);
    }
    return glint_lanes_equal(prims, lanes);
}

unsigned glint_bend_points(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t g,
                           unsigned lanes, const glint_derivative_points *points, double *const slope[9])
{
    _Alignas(64) double some[9][GLINT_GROUP];
    bend_buffers buffers;
    unsigned bent = 0;
    bool seen, moves;
    for (unsigned rest = lanes, same; rest; rest &= ~same) {
        same = begin(tile, frame, index, g, rest, points, &buffers, &seen, &moves);
        if (!moves)
            continue;
        if (!seen) {
            bent |= bend_each(tile, frame, index, g, same, points, slope);
            continue;
        }
        for (int k = 0; k < 9; k++)
            buffers.args.slope[k / 3][k % 3] = same == lanes ? slope[k] : some[k];
        frame->stages->bend(&buffers.args);
        if (same != lanes)
            put_lanes(same, some, slope);
        bent |= same;
    }
    return bent;
}
