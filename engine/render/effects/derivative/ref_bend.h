// The reference of bend.

/// The ray that sees a hit: the distance of the hit along the ray, and the ray's slopes.
typedef struct bent_ray {
    double direction[3], moved[3], turned[3], far;
} bent_ray;

static bent_ray seen_from_point(const glint_bend_args *args, int i)
{
    const glint_derivative_view *view = args->view;
    const glint_bend_camera *camera = args->camera;
    bent_ray out = { .far = 1 };
    for (int c = 0; c < 3; c++)
        out.direction[c] = view->moves ? args->points->point[c][i] - camera->eye[c] : -args->points->eye[c][i];
    for (int c = 0; c < 3; c++) {
        out.moved[c] = view->eye[c];
        out.turned[c] = dot_of(camera->turn[c], out.direction);
    }
    return out;
}

static bent_ray seen_along(const glint_bend_args *args, int i)
{
    const glint_derivative_view *view = args->view;
    const glint_bend_camera *camera = args->camera;
    const double x = args->screen[0][i], y = args->screen[1][i];
    double seen[3];
    bent_ray out;
    for (int c = 0; c < 3; c++) {
        const double across = x * camera->right[c] + y * camera->up[c], changed = x * view->right[c] + y * view->up[c];
        const double at = args->shift[c][i], slope = args->shift_slope[c][i];
        const bool parallel = camera->orthographic;
        seen[c] = args->points->point[c][i] - (camera->eye[c] + ((parallel ? across : 0) + at));
        out.direction[c] = camera->forward[c] + ((parallel ? 0 : across) - at * camera->near);
        out.moved[c] = view->eye[c] + ((parallel ? changed : 0) + slope);
        out.turned[c] = view->forward[c] + ((parallel ? 0 : changed) - (slope * camera->near + at * view->nearer));
    }
    out.far = dot_of(seen, out.direction) / dot_of(out.direction, out.direction);
    return out;
}

static void bend_lane(const glint_bend_args *args, int i)
{
    const bent_ray ray = args->screen[0] ? seen_along(args, i) : seen_from_point(args, i);
    const glint_prim *prim = args->prim;
    const glint_derivative_part *part = args->part;
    const bool round = prim->kind == GLINT_PRIM_SPHERE;
    double gradient[3], off[3], carried[3], normal[3], eye[3], rest = 0;
    for (int c = 0; c < 3; c++) {
        const double point = args->points->point[c][i];
        normal[c] = args->points->normal[c][i];
        eye[c] = args->points->eye[c][i];
        off[c] = point - prim->center[c];
        gradient[c] = round ? off[c] : prim->normal[c];
        carried[c] = ray.moved[c] + ray.far * ray.turned[c];
        rest += gradient[c] * ((part->position[c] - carried[c]) + part->growth * off[c]);
        rest -= round ? 0 : part->normal[c] * (point - part->pivot[c]);
    }
    const double further = rest / dot_of(gradient, ray.direction), side = dot_of(gradient, normal) < 0 ? -1 : 1;
    const double shorter = -1 / dot_of(ray.direction, eye), away = dot_of(ray.turned, eye);
    for (int c = 0; c < 3; c++) {
        const double moved = carried[c] + further * ray.direction[c];
        args->slope[0][c][i] = moved;
        args->slope[1][c][i] = side * part->normal[c];
        if (round)
            args->slope[1][c][i] = ((moved - part->position[c]) - off[c] * part->growth) * (side / prim->radius);
        args->slope[2][c][i] = (away * eye[c] - ray.turned[c]) * shorter;
    }
}

static void bend(const glint_bend_args *args)
{
    for (int i = 0; i < GLINT_GROUP; i++)
        bend_lane(args, i);
}
