/// How fast a hit moves on its surface, held to its ray, where the surface or the eye does.
#include "engine/tile/derivative_light.h"

#include "engine/base/vec.h"
#include "engine/tile/tile.h"

/// What of a way from the eye changes as the view turns: as far along it as the hit is.
static void turn_way(const glint_plan *plan, const glint_derivative_view *view, const double way[3], double out[3])
{
    const glint_plan_camera *c = &plan->camera;
    const double along = vec_dot(way, c->forward), across = vec_dot(way, c->right) / vec_dot(c->right, c->right),
                 down = vec_dot(way, c->up) / vec_dot(c->up, c->up);
    for (int i = 0; i < 3; i++)
        out[i] = (along * view->forward[i] + across * view->right[i]) + down * view->up[i];
}

/// A hit: where it is, and what moves it.
typedef struct bent_hit {
    double point[3], normal[3], way[3]; ///< the last: from the eye
    double turned[3]; ///< slope of the way
    double carried[3]; ///< slope of the point if it stayed as far from the eye
} bent_hit;

/// The slopes of point and normal. The surface is place . gradient = constant.
static void hold(const bent_hit *hit, const glint_prim *prim, const glint_derivative_part *part, double point[3],
                 double normal[3])
{
    double gradient[3], off[3], rest = 0;
    for (int c = 0; c < 3; c++) {
        off[c] = prim->kind == GLINT_PRIM_TRIANGLE ? 0 : hit->point[c] - prim->center[c];
        gradient[c] = prim->kind == GLINT_PRIM_SPHERE ? off[c] : prim->kind == GLINT_PRIM_PLANE ? prim->normal[c] : hit->normal[c];
        rest += gradient[c] * (part->place[c] - hit->carried[c]) - part->normal[c] * off[c];
    }
    rest += prim->kind == GLINT_PRIM_SPHERE ? prim->radius * part->radius : 0;
    const double further = rest / vec_dot(gradient, hit->way), side = vec_dot(gradient, hit->normal) < 0 ? -1 : 1;
    for (int c = 0; c < 3; c++) {
        point[c] = hit->carried[c] + further * hit->way[c];
        normal[c] = side * part->normal[c];
    }
    for (int c = 0; c < 3 && prim->kind == GLINT_PRIM_SPHERE; c++)
        normal[c] = side * ((point[c] - part->place[c]) - off[c] * (part->radius / prim->radius)) / prim->radius;
}

unsigned glint_bend_points(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t g,
                           unsigned lanes, const glint_derivative_points *points, double (*bend)[3][GLINT_GROUP])
{
    const glint_plan *plan = frame->plan;
    const glint_plan_derivative *d = &plan->derivatives->of[index];
    unsigned bent = 0;
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const unsigned i = (unsigned)__builtin_ctz(rest);
        const glint_prim *prim = &frame->geometry.prims[tile->at.prim[(size_t)g * GLINT_GROUP + i]];
        const glint_derivative_part *part = &d->parts[plan->geometry->prim_part[prim->id]];
        bent_hit hit;
        double point[3], normal[3], eye[3];
        if (!part->moves && !d->view.moves)
            continue;
        bent |= 1u << i;
        for (int c = 0; c < 3; c++) {
            hit.point[c] = points->point[c][i];
            hit.normal[c] = points->normal[c][i];
            eye[c] = points->eye[c][i];
            hit.way[c] = d->view.moves ? hit.point[c] - plan->camera.eye[c] : -eye[c];
        }
        turn_way(plan, &d->view, hit.way, hit.turned);
        for (int c = 0; c < 3; c++)
            hit.carried[c] = d->view.eye[c] + hit.turned[c];
        hold(&hit, prim, part, point, normal);
        const double length = sqrt(vec_dot(hit.way, hit.way)), away = vec_dot(hit.turned, eye);
        for (int c = 0; c < 3; c++) {
            bend[0][c][i] = point[c];
            bend[1][c][i] = normal[c];
            bend[2][c][i] = (away * eye[c] - hit.turned[c]) / length;
        }
    }
    return bent;
}
