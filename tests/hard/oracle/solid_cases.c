#include "tests/hard/oracle/solid_cases.h"

#include <string.h>

const solid_case solid_cases[] = {
    // The ray starts an ulp or two from a face's plane, nearly parallel to it. Within rounding, the ray is under that
    // face from the start, and enters through another face, far away.
    { "V1", "box, from an ulp beyond a face, along it",
      .ray = { { 0x1.30d5db6811a34p+16, 0x1.62a5baa45b9b6p+15, 0x1.11b94f0656f56p+17 },
               { -0x1.68p-28, -0x1.3e1b40492732ep+17, 0x1.3f0b374d7b92p+18 } },
      .kind = GLINT_SHAPE_BOX, .min = { -0x1.3a0ede05333cap+18, -0x1.6908401ee8ebcp+17, -0x1.cfd140a1e7075p+16 },
      .max = { 0x1.30d5db6811a33p+16, 0x1.60f77d093e4a4p+15, 0x1.4287ed90563e9p+19 }, .t = 0.0027777777777777779 },
    { "V2", "box, the same between other faces",
      .ray = { { -0x1.54e280ab30795p-13, -0x1.b4461c89d3acdp-13, 0x1.675f1aa95220bp-15 },
               { 0x1.276a074c6b353p-21, 0x1.f0c32c1b00ddap+19, -0x1.5b656cb139ecdp+23 } },
      .kind = GLINT_SHAPE_BOX, .min = { -0x1.54e280ab30794p-13, -0x1.edd59b59042e5p-13, -0x1.54518703af3d9p-12 },
      .max = { 0x1.6072cbfcf24afp-13, 0x1.602fcad56ad23p-15, 0x1.630dd97589f5cp-15 }, .t = 4.9259367070674298e-14 },
    { "V3", "box, the same within two edges",
      .ray = { { 0x1.64982c0296ef1p-18, -0x1.e7a90a2e17134p-21, -0x1.5c95cf32239e8p-20 },
               { -0x1.5eaff1fe9994dp-19, 0x1.688c1712b7cc2p-19, 0x1.56p-62 } },
      .kind = GLINT_SHAPE_BOX, .min = { -0x1.a618e87783472p-18, -0x1.24c73ffceb841p-20, -0x1.5c95cf32239e6p-20 },
      .max = { 0x1.646a1aa255eebp-18, 0x1.32d1b73bc93p-19, 0x1.74f31fb7a1afap-18 }, .t = 0.0014619883040935672 },
    // A disk flattened in two directions: the elements of the inverse are differences that nearly cancel.
    { "V4", "disk, flattened to a needle",
      .ray = { { -0x1.83e1b0d22a5b8p+7, 0x1.5ab248a689ee7p+8, -0x1.a455150e67442p+6 },
               { 0x1.6e6e63fc084p-2, -0x1.88e964824e9p+0, 0x1.50079a47ea28p-1 } },
      .kind = GLINT_SHAPE_DISK, .center = { 0x0p+0, -0x0p+0, -0x0p+0 },
      .normal = { 0x1.d516e75311196p-1, 0x1.874990f453a1bp-2, 0x1.ee9e6737be396p-4 }, .radius = 0x1.b434849eac587p+2,
      .map = { { 0x1.0b51ab3efc0cfp-4, 0x1.0b156ba5c7a19p-2, -0x1.0ab1144cc059ap+5, 0x0p+0 },
               { -0x1.40ecf90d049ebp-2, -0x1.c455a4348b9f9p-2, 0x1.dae62db0dbbbep+5, 0x0p+0 },
               { 0x1.8b75d51b58594p-4, 0x1.5785926369606p-3, -0x1.1f9c7f908b37ep+4, 0x0p+0 } },
      .t = 0.99999952271042791 },
    // A map that undoes the flattening of its child's map: M is small although its terms are large.
    { "V5", "cylinder, made round by its map",
      .ray = { { 0x1.3d78a45f30204p+15, -0x1.73ded04ab4097p+16, -0x1.caa1d494ef3c7p+19 },
               { -0x1.5a45b396dcfap+13, 0x1.e7f43187e60aep+15, 0x1.9ddefd642989cp+17 } },
      .kind = GLINT_SHAPE_CYLINDER, .base = { 0x1.8923aceee9bafp+16, 0x1.4d9b818e7b1bfp+13, 0x1.e0789a68f2746p+14 },
      .top = { 0x1.89114606798ecp+16, 0x1.4fcb04219c605p+13, 0x1.e1053eef710acp+14 }, .radius = 0x1.a7678f00204dp+15,
      .map = { { -0x1.52fc0e8d31134p+1, 0x1.aa3bfbf711134p+3, 0x1.1de1b08ea7effp+3, 0x0p+0 },
               { -0x1.b067f0e7ef702p+7, 0x1.9ec883273b9c3p+9, 0x1.9feae59aa4592p+8, 0x0p+0 },
               { -0x1.4c175c62b2f25p+9, 0x1.3b36492f95461p+11, 0x1.3d06c513973e9p+10, 0x0p+0 } },
      .t = 0.011255564900902735 },
    // A ray down the side of the other nappe of the double cone: the squares at the ray's origin almost cancel.
    { "V6", "cone, down its other half's side",
      .ray = { { 0x1.1603cb690892ap+11, 0x1.036a375d1d3adp+12, 0x1.afe54e0755471p+14 },
               { 0x1.013694758472ep+29, 0x1.5edccac15fe53p+29, -0x1.11486831bc98dp+33 } },
      .kind = GLINT_SHAPE_CONE, .base = { -0x1.38f531a4de77fp+10, 0x1.458d2c62b4ce2p+6, -0x1.6f56ab45e48fdp+12 },
      .top = { 0x1.950a989a9f21p+11, 0x1.6a04fc3816f15p+12, 0x1.1cd5d8105d1e6p+13 }, .radius = 0x1.413f048bac34ap+13,
      .t = 2.0521490628296824e-06 },
    { "V7", "cone, the same, nearer", .ray = { { 1.00001, 0.0001, 3 }, { -1.25, -0.0001, -2.5 } },
      .kind = GLINT_SHAPE_CONE, .base = { 0, 0, 0 }, .top = { 0, 0, 1 }, .radius = 0.5, .t = 0.8000199968006718 },
    // The answer is computed by hand. Both roots are 0 where the ray is nearest to the apex.
    { "V8", "cone, along its axis, from afar", .ray = { { 0, 0, 10 }, { 0, 0, -1 } }, .kind = GLINT_SHAPE_CONE,
      .base = { 0, 0, 0 }, .top = { 0, 0, 1 }, .radius = 0.5, .t = 9 },
    { "V9", "cone, along its axis, from near by", .ray = { { 0, 0, 1.25 }, { 0, 0, -0.5 } }, .kind = GLINT_SHAPE_CONE,
      .base = { 0, 0, 0 }, .top = { 0, 0, 1 }, .radius = 0.5, .t = 0.5 },
    { "V10", "cone, at its apex, within", .ray = { { 0.25, 0.125, 9 }, { -0.25, -0.125, -8 } },
      .kind = GLINT_SHAPE_CONE, .base = { 0, 0, 0 }, .top = { 0, 0, 1 }, .radius = 0.5, .t = 1 },
};

const int solid_case_count = sizeof solid_cases / sizeof *solid_cases;

hard_solid solid_of_case(const solid_case *c)
{
    static const double none[3][4];
    hard_solid s = { .desc = glint_shape_desc_default(c->kind) };
    memcpy(s.desc.center, c->center, sizeof c->center);
    memcpy(s.desc.normal, c->normal, sizeof c->normal);
    memcpy(s.desc.base, c->base, sizeof c->base);
    memcpy(s.desc.top, c->top, sizeof c->top);
    memcpy(s.desc.min, c->min, sizeof c->min);
    memcpy(s.desc.max, c->max, sizeof c->max);
    s.desc.radius = c->radius;
    if (memcmp(c->map, none, sizeof none) != 0)
        memcpy(s.desc.transform.m, c->map, sizeof c->map);
    return s;
}
