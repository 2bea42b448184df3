/// Indirect light by Embree 3, one ray at a time: its native spheres, rtcIntersect1 and rtcOccluded1 instead of the
/// plain program's loop over all spheres.
///
///   embree_lone frame indirect=SAMPLES scene=1k    ms
#include <embree3/rtcore.h>

#include "tests/bench/plain_path.h"

#define NEAR 1e-4F

typedef struct lone_side {
    RTCDevice device;
    RTCScene scene;
} lone_side;

static size_t nearest(const plain_scene *s, const double origin[3], const double dir[3], size_t leaving, double *far)
{
    const lone_side *side = s->side;
    struct RTCIntersectContext context;
    struct RTCRayHit ray = { .ray = { .org_x = (float)origin[0],
                                      .org_y = (float)origin[1],
                                      .org_z = (float)origin[2],
                                      .tnear = leaving == NO_SPHERE ? 0 : NEAR,
                                      .dir_x = (float)dir[0],
                                      .dir_y = (float)dir[1],
                                      .dir_z = (float)dir[2],
                                      .tfar = *far < 1e30 ? (float)*far : 1e30F,
                                      .mask = UINT32_MAX },
                             .hit = { .geomID = RTC_INVALID_GEOMETRY_ID } };
    rtcInitIntersectContext(&context);
    if (*far <= 1) { // a shadow ray: its direction reaches to the light, at t = 1
        rtcOccluded1(side->scene, &context, &ray.ray);
        return ray.ray.tfar < 0 ? 0 : NO_SPHERE;
    }
    rtcIntersect1(side->scene, &context, &ray);
    *far = (double)ray.ray.tfar;
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? NO_SPHERE : ray.hit.primID;
}

static void build(lone_side *side, const bench_scene *plain)
{
    RTCGeometry geometry = rtcNewGeometry(side->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *balls = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, plain->sphere_count);
    for (size_t i = 0; i < 4 * plain->sphere_count; i++)
        balls[i] = plain->spheres[i];
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(side->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(side->scene);
    if (rtcGetDeviceError(side->device) != RTC_ERROR_NONE)
        bench_fail("embree_lone", "the scene cannot be built");
}

int main(int argc, char **argv)
{
    plain_scene s = plain_scene_create(argc, argv);
    lone_side side = { .device = rtcNewDevice("threads=1") };
    side.scene = rtcNewScene(side.device);
    s.side = &side;
    build(&side, &s.plain);
    plain_measure(&s);
    rtcReleaseScene(side.scene);
    rtcReleaseDevice(side.device);
    bench_scene_free(&s.plain);
    return 0;
}
