#include "tests/hard/oracle/aim.h"
#include "tests/hard/oracle/drive.h"

#include <math.h>
#include <string.h>

/// Returns 1 plus or minus a log-uniform number between low and high.
static double near_one(double low, double high) { return 1 + (chance(0.5) ? -1 : 1) * log_uniform(low, high); }

/// Sets `side` to a unit vector perpendicular to u.
static void random_side(const double u[3], double side[3])
{
    double v[3], along, length = 0;
    do {
        random_direction(v);
        along = v[0] * u[0] + v[1] * u[1] + v[2] * u[2];
    } while (fabs(along) > 0.99);
    for (int c = 0; c < 3; c++) {
        side[c] = v[c] - along * u[c];
        length += side[c] * side[c];
    }
    for (int c = 0; c < 3; c++)
        side[c] /= sqrt(length);
}

static void axis(double v[3])
{
    memset(v, 0, 3 * sizeof *v);
    v[random_bits() % 3] = chance(0.5) ? -1 : 1;
}

/// Returns a random distance of the ray's origin from the centre, in radii.
static double random_distance(void)
{
    switch (random_bits() % 6) {
    case 0:
        return near_one(1e-16, 1e-8); // on the surface, or almost on it
    case 1:
        return near_one(1e-8, 1);
    case 2:
        return chance(0.2) ? 0 : uniform(0, 1);
    case 3:
        return 1;
    default:
        return log_uniform(1, 1e8);
    }
}

static void random_place(double place[3], double size)
{
    const double reach = size * log_uniform(1e-3, 1e7);
    const bool whole = chance(0.3); // with whole numbers, differences are exact
    for (int c = 0; c < 3; c++) {
        place[c] = chance(0.4) ? 0 : uniform(-1, 1) * reach;
        if (whole)
            place[c] = size * rint(place[c] / size);
    }
}

/// Scales a direction to any length, denormal to huge; sometimes makes components negligible next to the others.
static void stretch(double d[3])
{
    const double length = chance(0.2)   ? ldexp(1, -1060 + (int)(random_bits() % 2040))
                          : chance(0.5) ? 1
                                        : log_uniform(1e-30, 1e30);
    for (int c = 0; c < 3; c++)
        d[c] *= length;
    if (chance(0.05))
        d[random_bits() % 3] *= log_uniform(1e-300, 1);
    if (d[0] == 0 && d[1] == 0 && d[2] == 0)
        d[2] = -1;
}

void aim_at_sphere(hard_ray *ray, hard_sphere *sphere)
{
    const double size = chance(0.3) ? ldexp(1, -26 + (int)(random_bits() % 53)) : log_uniform(1e-8, 1e8);
    double u[3], side[3];
    sphere->r = chance(0.3) ? size : size * uniform(0.5, 1);
    random_place(sphere->c, size);
    if (chance(0.2))
        axis(u);
    else
        random_direction(u);
    const double away = random_distance() * sphere->r;
    for (int c = 0; c < 3; c++)
        ray->o[c] = sphere->c[c] - u[c] * away;
    random_side(u, side);
    const double miss = sphere->r * (chance(0.5) ? near_one(1e-16, 1e-2) : uniform(0, 1.2));
    // From far away, the line passes the centre at the distance `miss`.
    // From nearby or inside, the direction is random.
    const double sine = away > miss ? miss / away : 0, cosine = sqrt(1 - sine * sine);
    for (int c = 0; c < 3; c++)
        ray->d[c] = away > miss ? u[c] * cosine + side[c] * sine : side[c] + u[c] * uniform(-1, 1);
    if (chance(0.1))
        for (int c = 0; c < 3; c++)
            ray->d[c] = -ray->d[c];
    stretch(ray->d);
}

void aim_at_plane(hard_ray *ray, hard_plane *plane)
{
    const double size = log_uniform(1e-8, 1e8);
    double unit[3], side[3], across[3];
    if (chance(0.3))
        axis(unit);
    else
        random_direction(unit);
    random_side(unit, side);
    random_side(unit, across);
    random_place(plane->p, size);
    const double height = chance(0.1) ? 0 : size * (chance(0.3) ? log_uniform(1e-16, 1) : uniform(-1, 1));
    const double climb = chance(0.5) ? log_uniform(1e-16, 1e-2) : uniform(-1, 1), along = size * log_uniform(1e-3, 1e6);
    const double length = chance(0.5) ? 1 : log_uniform(1e-100, 1e100);
    for (int c = 0; c < 3; c++) {
        ray->o[c] = plane->p[c] + unit[c] * height + across[c] * along;
        ray->d[c] = side[c] - unit[c] * (chance(0.9) ? climb : -climb);
        plane->n[c] = unit[c] * length;
    }
    stretch(ray->d);
}

void aim_at_many(hard_ray *ray, hard_sphere *spheres, int count)
{
    aim_at_sphere(ray, &spheres[0]);
    for (int i = 1; i < count; i++) {
        spheres[i] = spheres[random_bits() % (unsigned)i];
        switch (random_bits() % 4) {
        case 0:
            break; // a sphere identical to the previous one
        case 1:
            spheres[i].r = nextafter(spheres[i].r, chance(0.5) ? 0 : HUGE_VAL);
            break;
        case 2:
            spheres[i].r *= near_one(1e-15, 1e-6);
            break;
        default:
            for (int c = 0; c < 3; c++)
                spheres[i].c[c] += spheres[i].r * uniform(-1, 1);
        }
    }
}
