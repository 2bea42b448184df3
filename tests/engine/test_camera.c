/// Cameras given in pixels: the rays of pixels against a projection computed here in double.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "engine/render/plan/plan.h"

/// A rotation with rational entries: x to the right, y down, z away from the eye.
static const double ROTATION[3][3] = { { 0.8, 0, -0.6 }, { 0.36, 0.8, 0.48 }, { 0.48, -0.6, 0.64 } };

static glint_camera_desc camera_at(const double shift[3])
{
    glint_camera_desc desc = glint_camera_desc_default();
    desc.has_direction = true;
    for (int c = 0; c < 3; c++) {
        desc.eye[c] = -((ROTATION[0][c] * shift[0] + ROTATION[1][c] * shift[1]) + ROTATION[2][c] * shift[2]);
        desc.direction[c] = ROTATION[2][c];
        desc.up[c] = -ROTATION[1][c];
    }
    return desc;
}

/// Projects a point with the plan's camera, to pixels.
static void project(const glint_plan_camera *camera, const double point[3], double out[2])
{
    double way[3], along = 0, across = 0, above = 0, right = 0, up = 0;
    for (int c = 0; c < 3; c++) {
        way[c] = point[c] - camera->eye[c];
        along += way[c] * camera->forward[c];
        across += way[c] * camera->right[c];
        above += way[c] * camera->up[c];
        right += camera->right[c] * camera->right[c];
        up += camera->up[c] * camera->up[c];
    }
    out[0] = (camera->span[0] + across / right / along) / 2;
    out[1] = (camera->span[1] - above / up / along) / 2;
}

static void test_projection(void **state)
{
    static const double points[][3] = { { 0, 0, 0 },      { 1.2, 0.5, -0.3 }, { -1, -1.5, 0.4 },
                                        { 0.2, -0.9, 2 }, { 2.5, 1, 1 },      { -3, 2, 5 } };
    static const double shift[3] = { 0.3, -0.2, 7 };
    (void)state;
    for (int scale = 1; scale <= 3; scale++) {
        glint_camera_desc desc = camera_at(shift);
        glint_plan_camera camera;
        desc.fx = 812.5;
        desc.fy = 790.25;
        desc.has_cx = desc.has_cy = true;
        desc.cx = 301.75;
        desc.cy = 255.5;
        desc.w = 640;
        desc.h = 480;
        glint_plan_camera_init(&camera, &desc, scale * desc.w, scale * desc.h);
        for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
            double q[3], seen[2];
            for (int r = 0; r < 3; r++)
                q[r] =
                    ((ROTATION[r][0] * points[i][0] + ROTATION[r][1] * points[i][1]) + ROTATION[r][2] * points[i][2]) +
                    shift[r];
            project(&camera, points[i], seen);
            const double want[2] = { scale * (desc.fx * q[0] / q[2] + desc.cx),
                                     scale * (desc.fy * q[1] / q[2] + desc.cy) };
            for (int c = 0; c < 2; c++)
                assert_true(fabs(seen[c] - want[c]) <= 1e-12 * fabs(want[c]));
        }
    }
}

static void test_window(void **state)
{
    double window[4];
    glint_camera_desc desc = glint_camera_desc_default();
    (void)state;
    desc.fx = 100;
    desc.fy = 50;
    desc.has_cx = desc.has_cy = true;
    desc.cx = 30;
    desc.cy = -10;
    glint_camera_window(&desc, 200, 100, window);
    const double want[4] = { -0.3, 1.7, -2.2, -0.2 };
    for (int i = 0; i < 4; i++)
        assert_true(fabs(window[i] - want[i]) < 1e-15);
    desc = glint_camera_desc_default();
    desc.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
    desc.height = 3;
    glint_camera_window(&desc, 200, 100, window);
    assert_true(window[0] == -3 && window[1] == 3 && window[2] == -1.5 && window[3] == 1.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_projection), cmocka_unit_test(test_window) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
