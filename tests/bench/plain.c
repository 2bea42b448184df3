/// Indirect light in plain C, as written in an hour: every ray against every sphere, one at a time, in double.
///
///   plain frame indirect=SAMPLES [scene=workshop]    ms; one bounce, without highlights, which indirect paths ignore
#include "tests/bench/plain_path.h"

static size_t nearest(const plain_scene *s, const double origin[3], const double dir[3], size_t leaving, double *far)
{
    double a = plain_dot(dir, dir);
    size_t found = NO_SPHERE;
    for (size_t i = 0; i < s->plain.sphere_count; i++) {
        const float *ball = s->plain.spheres + 4 * i;
        double to[3], radius = (double)ball[3];
        for (int c = 0; c < 3; c++)
            to[c] = (double)ball[c] - origin[c];
        double b = plain_dot(to, dir), root = b * b - a * (plain_dot(to, to) - radius * radius);
        if (i == leaving || root <= 0 || b <= 0)
            continue;
        double t = (b - sqrt(root)) / a;
        if (t > 0 && t < *far) {
            *far = t;
            found = i;
        }
    }
    return found;
}

int main(int argc, char **argv)
{
    plain_scene s = plain_scene_create(argc, argv);
    plain_measure(&s);
    bench_scene_free(&s.plain);
    return 0;
}
