/// Rays for the tests of the stages, as a frame has them: a camera's tile, parallel rays, individual rays; and scenes
/// with primitives close to these rays.
#ifndef GLINT_STAGE_RAYS_H
#define GLINT_STAGE_RAYS_H

#include "tests/engine/cases/stage_scene.h"

typedef enum ray_kind {
    RAYS_OF_EYE, ///< rays of a perspective camera, for cast_bundle
    RAYS_OF_PIXELS, ///< rays of pixels at arbitrary positions, for cast_bundle
    RAYS_OF_ORTHOGRAPHIC_CAMERA, ///< parallel rays, for cast_rays
    RAYS_OF_LENS, ///< rays of a lens under either projection, for cast_rays
    RAYS_PARALLEL, ///< parallel rays in each group, for cast_rays
    RAYS_ALIKE, ///< rays in nearly the same direction, for cast_rays
    RAYS_FREE, ///< individual rays, for cast_rays
    RAY_KINDS
} ray_kind;

/// A case for cast. The arrays are inputs of stage_case.h.
typedef struct ray_case {
    ray_kind kind;
    int precision;
    scene_plan plan;
    test_scene *scene;
    glint_camera_args camera;
    glint_lens lens; ///< the lens that camera.lens points to, for RAYS_OF_LENS
    glint_cast_args cast;
    const void *origin[3], *direction[3]; ///< origins and directions of rays that are stored in arrays
} ray_case;

static inline bool is_from_eye(ray_kind kind) { return kind == RAYS_OF_EYE || kind == RAYS_OF_PIXELS; }

// ---- Cameras -----------------------------------------------------------------------------------------------------

/// Chooses the tile's position in the image, and its size. Returns the height of the image.
static inline double random_tile(glint_camera_args *camera)
{
    const uint32_t most = one_in(3) ? 20000 : 300, width = 1 + below(most), height = 1 + below(most);
    camera->width = width;
    camera->height = height;
    camera->x0 = GLINT_TILE_WIDTH * below((width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH);
    camera->y0 = GLINT_TILE_HEIGHT * below((height + GLINT_TILE_HEIGHT - 1) / GLINT_TILE_HEIGHT);
    camera->groups_across = GLINT_TILE_WIDTH / 4;
    uint32_t down = GLINT_TILE_HEIGHT / 4;
    if (one_in(3)) {
        camera->groups_across = 1 + below(GLINT_TILE_WIDTH / 4);
        down = 1 + below(GLINT_TILE_HEIGHT / 4);
    }
    camera->group_count = camera->groups_across * down;
    for (int c = 0; c < 2; c++)
        camera->offset[c] = one_in(2) ? 0.5 : one_in(4) ? below(2) : between(0, 1);
    return height;
}

/// A camera that looks at the middle of the scene from inside, from nearby or from up to 1e7 scene sizes away.
/// Returns the distance to the middle.
static inline double random_camera(const scene_plan *plan, bool orthographic, glint_camera_args *camera)
{
    *camera = (glint_camera_args) { .orthographic = orthographic };
    const double height = random_tile(camera), size = plan->size;
    const double distance = size * (one_in(4) ? power_of_ten(4, 7) : one_in(5) ? between(0, 1) : between(1, 10));
    // distance from the axis to the edge of the picture
    const double seen = size * (one_in(4) ? power_of_ten(-4, 0) : between(0.3, 3));
    random_unit(camera->forward);
    random_across(camera->forward, camera->right);
    if (one_in(3)) { // axis-aligned: the edges of boxes coincide with the borders of groups
        const uint32_t axis = below(3);
        memset(camera->forward, 0, sizeof camera->forward);
        memset(camera->right, 0, sizeof camera->right);
        camera->forward[axis] = either_sign(1);
        camera->right[(axis + 1) % 3] = either_sign(1);
    }
    cross3(camera->right, camera->forward, camera->up);
    along3(plan->middle, -distance, camera->forward, camera->eye);
    const double edge = orthographic ? seen : one_in(10) ? power_of_ten(0, 1.5) : fmin(seen / distance, 30);
    for (int c = 0; c < 3; c++) {
        camera->right[c] *= edge / height;
        camera->up[c] *= edge / height;
    }
    return distance;
}

/// A lens of a camera that looks at the middle of the scene: from tiny to larger than the scene, focused on the
/// middle or at any distance. Its points include the centre and the rim.
static inline void random_lens(double size, double distance, glint_camera_args *camera, glint_lens *lens)
{
    const double focus = one_in(3) ? size * power_of_ten(-6, 7) : fmax(distance, 1e-3 * size) * power_of_ten(-1, 1);
    lens->radius = one_in(3) ? focus * power_of_ten(-8, 3) : size * power_of_ten(-3, 0.5);
    lens->per_focus = 1 / focus;
    for (int i = 0; i < GLINT_GROUP; i++) {
        const double angle = between(0, 6.3), radius = lens->radius * (one_in(4) ? below(2) : between(0, 1));
        const double x = 0.999999 * radius * cos(angle) / length3(camera->right);
        const double y = 0.999999 * radius * sin(angle) / length3(camera->up);
        for (int c = 0; c < 3; c++) {
            lens->shift[c][i] = x * camera->right[c] + y * camera->up[c];
            lens->bend[c][i] = lens->shift[c][i] * lens->per_focus;
        }
    }
    camera->lens = lens;
}

/// Chooses pixels of the tile in random order, one per lane.
static inline void scatter_pixels(glint_camera_args *camera)
{
    const double first[2] = { camera->x0, camera->y0 };
    const uint32_t size[2] = { 1 + below(GLINT_TILE_WIDTH), 1 + below(GLINT_TILE_HEIGHT) };
    camera->groups_across = 1;
    for (int k = 0; k < 2; k++) {
        double *pixel = input(KIND_DOUBLE, camera->group_count * GLINT_GROUP);
        for (uint32_t i = 0; i < camera->group_count * GLINT_GROUP; i++)
            pixel[i] = first[k] + below(size[k]);
        camera->pixel[k] = pixel;
        camera->end[k] = first[k] + size[k];
    }
}

/// Marks the pixels of the tile that are inside the image; sometimes a random mask.
static inline uint16_t *active_pixels(const glint_camera_args *camera)
{
    uint16_t *active = masks(camera->group_count);
    if (camera->pixel[0] || one_in(4))
        return active;
    for (uint32_t i = 0; i < camera->group_count * GLINT_GROUP; i++) {
        const uint32_t group = i / GLINT_GROUP, lane = i % GLINT_GROUP, bit = 1u << lane;
        const double x = camera->x0 + 4 * (group % camera->groups_across) + lane % 4;
        const double y = camera->y0 + 4 * (group / camera->groups_across) + lane / 4;
        active[group] =
            (uint16_t)(x < camera->width && y < camera->height ? active[group] | bit : active[group] & ~bit);
    }
    return active;
}

static inline void make_axes(glint_camera_args *camera, int precision)
{
    camera->across = input(real_kind(precision), 3 * GLINT_GROUP * camera->groups_across);
    camera->down = input(real_kind(precision), 3 * GLINT_GROUP * (camera->group_count / camera->groups_across));
}

/// Generates the camera's rays again after a change of the camera.
static inline void shoot_camera(ray_case *c)
{
    glint_camera_args args = c->camera;
    memcpy(args.origin, c->origin, sizeof args.origin);
    memcpy(args.direction, c->direction, sizeof args.direction);
    if (args.lens) {
        args.across = input(real_kind(c->precision), 3 * GLINT_GROUP * args.groups_across);
        args.down = input(real_kind(c->precision), 3 * GLINT_GROUP * (args.group_count / args.groups_across));
    }
    glint_stages_ref.geometry[c->precision].camera(&args);
}

// ---- Rays --------------------------------------------------------------------------------------------------------

static inline void get3(const void *const array[3], int precision, uint32_t i, double v[3])
{
    for (int c = 0; c < 3; c++)
        v[c] = get(array[c], precision, i);
}

static inline void get_ray(const ray_case *c, uint32_t i, double origin[3], double direction[3])
{
    if (!is_from_eye(c->kind)) {
        get3(c->origin, c->precision, i, origin);
        get3(c->direction, c->precision, i, direction);
        return;
    }
    const uint32_t lane = i % GLINT_GROUP, group = i / GLINT_GROUP, across = c->camera.groups_across;
    for (uint32_t k = 0; k < 3; k++) {
        direction[k] = get(c->camera.across, c->precision, (3 * (group % across) + k) * GLINT_GROUP + lane) +
                       get(c->camera.down, c->precision, (3 * (group / across) + k) * GLINT_GROUP + lane);
        direction[k] = c->precision == GLINT_PRECISION_FLOAT ? (float)direction[k] : direction[k];
        origin[k] = c->precision == GLINT_PRECISION_FLOAT ? (float)c->camera.eye[k] : c->camera.eye[k];
    }
}

/// Rays from around one point or from everywhere, most of them towards the scene.
static inline void shoot_free(ray_case *c)
{
    const scene_plan *plan = &c->plan;
    double source[3], way[3] = { 0 }, direction[3], origin[3], target[3], spread = 0;
    const double distance = plan->size * power_of_ten(-2, one_in(4) ? 7 : 1);
    const double jitter = one_in(3) ? 0 : plan->size * power_of_ten(-16, 1);
    random_unit(direction);
    along3(plan->middle, -distance, direction, source);
    for (uint32_t i = 0; i < c->cast.group_count * GLINT_GROUP; i++) {
        for (int k = 0; k < 3; k++) {
            origin[k] = source[k] + jitter * between(-1, 1);
            target[k] = plan->middle[k] + plan->size * between(-1, 1);
        }
        if (c->kind == RAYS_FREE || i % GLINT_GROUP == 0) {
            const double length = power_of_ten(-1, 1) / (distance + plan->size);
            random_unit(way);
            for (int k = 0; k < 3 && !one_in(5); k++)
                way[k] = (target[k] - origin[k]) * length;
            if (one_in(6)) // along an axis or in a coordinate plane
                way[below(3)] = way[below(3)] = either_sign(0);
            if (!(length3(way) > 0))
                random_unit(way);
            spread = c->kind == RAYS_ALIKE ? length3(way) * power_of_ten(-9, 0) : 0;
        }
        for (int k = 0; k < 3; k++)
            direction[k] = spread > 0 && !one_in(4) ? way[k] + spread * between(-1, 1) : way[k];
        put3(c->origin, c->precision, i, origin);
        put3(c->direction, c->precision, i, direction);
    }
}

/// Picks rays as the lines around which the scene is built; half of these rays are at the border of the tile.
static inline void choose_lines(ray_case *c, double length)
{
    const uint32_t across = c->camera.groups_across, down = c->cast.group_count / across;
    for (uint32_t k = 0; k < 64; k++) {
        uint32_t i = below(c->cast.group_count * GLINT_GROUP);
        double origin[3], direction[3];
        if (one_in(2)) { // a pixel in the first or last column or row
            uint32_t x = below(4 * across), y = below(4 * down);
            if (one_in(2))
                x = one_in(2) ? 0 : 4 * across - 1;
            else
                y = one_in(2) ? 0 : 4 * down - 1;
            i = (y / 4 * across + x / 4) * GLINT_GROUP + y % 4 * 4 + x % 4;
        }
        get_ray(c, i, origin, direction);
        const double size = length3(direction);
        if (size > 0 && isfinite(size) && isfinite(length3(origin)))
            add_line(&c->plan, origin, direction, length);
    }
    if (c->plan.line_count == 0)
        add_line(&c->plan, c->plan.middle, (const double[3]) { 0, 0, 1 }, c->plan.size);
}

/// Makes rays of one kind, and a scene around them. Ends with end_rays.
static inline void start_rays(ray_case *c, ray_kind kind, int precision)
{
    memset(c, 0, sizeof *c);
    c->kind = kind;
    c->precision = precision;
    random_place(&c->plan, true);
    const bool orthographic = kind == RAYS_OF_ORTHOGRAPHIC_CAMERA || (kind == RAYS_OF_LENS && one_in(3));
    double length = random_camera(&c->plan, orthographic, &c->camera);
    if (kind == RAYS_OF_LENS)
        random_lens(c->plan.size, length, &c->camera, &c->lens);
    if (kind == RAYS_OF_PIXELS)
        scatter_pixels(&c->camera);
    const uint32_t n = c->camera.group_count * GLINT_GROUP;
    c->cast = (glint_cast_args) { .group_count = c->camera.group_count };
    c->cast.active = active_pixels(&c->camera);
    if (is_from_eye(kind)) {
        make_axes(&c->camera, precision);
    } else {
        input3(c->origin, real_kind(precision), n);
        input3(c->direction, real_kind(precision), n);
    }
    if (kind >= RAYS_PARALLEL) {
        shoot_free(c);
        length = c->plan.size;
    } else {
        shoot_camera(c);
    }
    choose_lines(c, length);
    c->scene = random_scene(&c->plan);
    c->cast.geometry = &c->scene->table;
    c->cast.camera = kind >= RAYS_PARALLEL ? NULL : &c->camera;
    memcpy(c->cast.origin, c->origin, sizeof c->cast.origin);
    memcpy(c->cast.direction, c->direction, sizeof c->cast.direction);
}

static inline void end_rays(ray_case *c) { free_scene(c->scene); }

/// Casts on one instruction set.
static inline void cast_on(const glint_stages *stages, const ray_case *c, const glint_cast_args *args)
{
    if (is_from_eye(c->kind))
        stages->geometry[c->precision].cast_bundle(args);
    else
        stages->geometry[c->precision].cast_rays(args);
}

#endif
