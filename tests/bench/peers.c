/// Writes a scene to stdout for POV-Ray 3.7 or Tachyon 0.99, so that they render the same as the other sides.
///
///   peers povray|tachyon [scene=NAME] [shadows=0] [lens=1] [samples=N]
///       [area=1] [lamps=N] [change=light|shininess]
///       [pattern=NAME]
///
/// POV-Ray: the formulas match ours term by term (see tests/povray/pov.lua). With change=... it writes the scene of
/// the job's frame `frame_number`. Tachyon: also Phong; it has no area lights, and writes linear pixel values.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/bench/options.h"
#include "tests/bench/scenes.h"

static void print3(const char *format, const float v[3]) { printf(format, (double)v[0], (double)v[1], (double)v[2]); }

// ---- POV-Ray ----

/// POV-Ray's aperture is four times the radius of the lens: see tests/povray/pov.lua.
static void povray_lens(const bench_scene *s, const bench_options *o, const double forward[3])
{
    const double focus = (double)s->lens_focus;
    printf(" aperture %.9g blur_samples %d variance 0", 4 * (double)s->lens_radius, o->samples);
    printf(" focal_point <%.9g, %.9g, %.9g>", (double)s->eye[0] + focus * forward[0], (double)s->eye[1] + focus * forward[1],
           (double)s->eye[2] + focus * forward[2]);
}

static void povray_camera(const bench_scene *s, const bench_options *o)
{
    bench_camera c = bench_camera_of(s);
    double forward[3], right[3], up[3];
    for (int k = 0; k < 3; k++) {
        right[k] = BENCH_WIDTH * c.right[k];
        up[k] = -BENCH_HEIGHT * c.down[k];
        forward[k] = c.corner[k] + 0.5 * right[k] - 0.5 * up[k];
    }
    printf("camera { %s", s->height > 0 ? "orthographic" : "perspective");
    print3(" location <%.9g, %.9g, %.9g>", s->eye);
    printf(" direction <%.9g, %.9g, %.9g>", forward[0], forward[1], forward[2]);
    printf(" right <%.9g, %.9g, %.9g>", right[0], right[1], right[2]);
    printf(" up <%.9g, %.9g, %.9g>", up[0], up[1], up[2]);
    if (o->lens)
        povray_lens(s, o, forward);
    puts(" }");
}

static void povray_light(const bench_scene *s, const bench_options *o, const double at[3], bool moves)
{
    if (moves)
        printf("light_source { <13*cos(2*pi*(frame_number-1)/%d), 20, 13*sin(2*pi*(frame_number-1)/%d)> rgb 1",
               BENCH_FRAMES, BENCH_FRAMES);
    else
        printf("light_source { <%.9g, %.9g, %.9g> rgb %.9g", at[0], at[1], at[2], 1.0 / o->lamps);
    double side = 2 * (double)s->light_radius;
    if (o->area)
        printf(" area_light <%g, 0, 0>, <0, 0, %g>, 4, 4 circular orient", side, side);
    puts(o->shadows ? " }" : " shadowless }");
}

/// Writes the texture of the first material. It shows the same pattern as glint's program of this name, except for
/// the noise function: glint's `p` is higher than POV-Ray's by the floor's radius, an integer. The range of f_noise3d
/// is 0 .. 1.
static void povray_pigment(const bench_material *p, const char *pattern)
{
    const char *map = "color_map { [0 rgb 0.9] [1 rgb <0.05, 0.15, 0.25>] }";
    if (strcmp(pattern, "checker") == 0)
        printf("pigment { checker rgb 0.9 rgb 0.05 }");
    else if (strcmp(pattern, "checker-function") == 0)
        printf("pigment { function { mod(floor(x) + floor(y) + floor(z) + 2e4, 2) } color_map { [0 rgb 0.9] [1 rgb 0.05] } }");
    else if (strcmp(pattern, "marble") == 0)
        printf("pigment { marble turbulence 0.5 octaves 3 %s }", map);
    else if (strcmp(pattern, "marble-function") == 0)
        printf("pigment { function { 0.5 + 0.5 * sin(7 * x + 10 * (f_noise3d(x, y, z) + f_noise3d(2 * x, 2 * y, 2 * z) / 2 + "
               "f_noise3d(4 * x, 4 * y, 4 * z) / 4)) } %s }", map);
    else
        print3("pigment { rgb <%.9g, %.9g, %.9g> }", p->diffuse);
}

static void povray_torus(const bench_solid *t)
{
    double y[3], x[3], length = 0;
    int least = 0;
    for (int c = 0; c < 3; c++) {
        y[c] = (double)t->ball[c];
        least = fabs(y[c]) < fabs(y[least]) ? c : least;
    }
    const double e[3] = { least == 0, least == 1, least == 2 };
    for (int c = 0; c < 3; c++) {
        x[c] = y[(c + 1) % 3] * e[(c + 2) % 3] - y[(c + 2) % 3] * e[(c + 1) % 3];
        length = hypot(length, x[c]);
    }
    for (int c = 0; c < 3; c++)
        x[c] /= length;
    printf("torus { %.9g, %.9g sturm matrix <%.9g, %.9g, %.9g, %.9g, %.9g, %.9g", (double)t->size, (double)t->ball[3], x[0], x[1], x[2],
           y[0], y[1], y[2]);
    for (int c = 0; c < 3; c++)
        printf(", %.9g", x[(c + 1) % 3] * y[(c + 2) % 3] - x[(c + 2) % 3] * y[(c + 1) % 3]);
    print3(", %.9g, %.9g, %.9g>", t->center);
    printf(" texture { M%u } }\n", (unsigned)t->material);
}

static void povray_rod(const bench_solid *rod)
{
    const bool cone = rod->kind == BENCH_TIP;
    print3(cone ? "cone { <%.9g, %.9g, %.9g>," : "cylinder { <%.9g, %.9g, %.9g>,", rod->center);
    if (cone)
        printf(" %.9g,", (double)rod->size);
    print3(" <%.9g, %.9g, %.9g>,", rod->ball);
    printf(" %.9g texture { M%u } }\n", cone ? 0.0 : (double)rod->size, (unsigned)rod->material);
}

static void povray_solid(const bench_solid *solid)
{
    if (solid->kind == BENCH_TORUS) {
        povray_torus(solid);
        return;
    }
    if (solid->kind == BENCH_ROD || solid->kind == BENCH_TIP) {
        povray_rod(solid);
        return;
    }
    const float *at = solid->center, *ball = solid->ball, r = solid->size;
    const float low[3] = { at[0] - r, at[1] - r, at[2] - r }, high[3] = { at[0] + r, at[1] + r, at[2] + r };
    const bool cut = solid->kind == BENCH_CUT;
    const unsigned m = (unsigned)solid->material;
    printf("%sbox {", cut ? "difference { " : "");
    print3(" <%.9g, %.9g, %.9g>,", low);
    print3(" <%.9g, %.9g, %.9g> ", high);
    cut ? printf("}") : printf("texture { M%u } }\n", m);
    print3(" sphere { <%.9g, %.9g, %.9g>,", ball);
    cut ? printf(" %.9g } texture { M%u } }\n", (double)ball[3], m) : printf(" %.9g texture { M%u } }\n", (double)ball[3], m);
}

static void povray_mesh(const bench_scene *s)
{
    printf("mesh2 { vertex_vectors { %zu", s->vertex_count);
    for (size_t i = 0; i < s->vertex_count; i++)
        print3(",\n<%.9g, %.9g, %.9g>", s->vertices + 3 * i);
    printf(" }\nface_indices { %zu", s->triangle_count);
    for (size_t i = 0; i < s->triangle_count; i++) {
        const uint32_t *corner = s->triangles + 3 * i;
        printf(",\n<%u, %u, %u>", (unsigned)corner[0], (unsigned)corner[1], (unsigned)corner[2]);
    }
    puts(s->materials[0].transmission > 0 ? " } texture { M0 } interior { ior 1.5 } }" : " } texture { M0 } }");
}

static void write_povray(const bench_scene *s, const bench_options *o)
{
    bool changes = strcmp(o->change, "none") != 0, shines = strcmp(o->change, "shininess") == 0;
    puts("#version 3.7;\nglobal_settings { assumed_gamma 1.0 ambient_light rgb 1 max_trace_level 6 }"); // glint's max_depth 5
    if (strstr(o->pattern, "-function"))
        puts("#declare f_noise3d = function(x, y, z) { internal(76) };"); // declared as in functions.inc
    print3("background { rgb <%.9g, %.9g, %.9g> }\n", s->background);
    povray_camera(s, o);
    for (int i = 0; i < o->lamps; i++) {
        double at[3];
        bench_lamp(s, i, o->lamps, at);
        povray_light(s, o, at, changes && !shines);
    }
    for (int m = 0; m < s->material_count; m++) {
        const bench_material *p = &s->materials[m];
        printf("#declare M = texture { ");
        if (p->transmission > 0) {
            printf("pigment { rgb 0 transmit %.9g } finish { ambient 0 diffuse 0 specular 0 } }\n", (double)p->transmission);
            printf("#declare M%d = M;\n", m);
            continue;
        }
        povray_pigment(p, m == 0 ? o->pattern : "none");
        print3(" finish { ambient <%.9g, %.9g, %.9g> diffuse 1 specular 0", s->ambient);
        if (p->mirror > 0)
            printf(" reflection { rgb %.9g }", (double)p->mirror);
        if (p->specular > 0 && shines)
            printf(" phong %.9g phong_size 8*pow(2, (frame_number-1)/10)", (double)p->specular);
        else if (p->specular > 0)
            printf(" phong %.9g phong_size %.9g", (double)p->specular, (double)p->shininess);
        printf(" } }\n#declare M%d = M;\n", m);
    }
    for (size_t i = 0; i < s->sphere_count; i++) {
        const float *p = s->spheres + 4 * i;
        print3("sphere { <%.9g, %.9g, %.9g>", p);
        printf(", %.9g texture { M%u }%s }\n", (double)p[3], (unsigned)s->sphere_material[i],
               s->materials[s->sphere_material[i]].transmission > 0 ? " interior { ior 1.5 }" : "");
    }
    for (size_t i = 0; i < s->solid_count; i++)
        povray_solid(&s->solids[i]);
    if (s->triangle_count > 0)
        povray_mesh(s);
}

// ---- Tachyon ----

static void print_mirrored(const char *format, const float v[3])
{
    printf(format, (double)v[0], (double)v[1], -(double)v[2]);
}

/// Tachyon's world is left-handed: z is mirrored.
static void write_tachyon(const bench_scene *s, const bench_options *o)
{
    bench_camera c = bench_camera_of(s);
    double forward[3];
    for (int k = 0; k < 3; k++)
        forward[k] = c.corner[k] + 0.5 * BENCH_WIDTH * c.right[k] + 0.5 * BENCH_HEIGHT * c.down[k];
    double height = BENCH_HEIGHT * sqrt(c.down[0] * c.down[0] + c.down[1] * c.down[1] + c.down[2] * c.down[2]);
    printf("BEGIN_SCENE\nRESOLUTION %d %d\n", BENCH_WIDTH, BENCH_HEIGHT);
    printf("CAMERA\nPROJECTION PERSPECTIVE\nZOOM %.9g\nASPECTRATIO 1.0\nANTIALIASING %d\nRAYDEPTH 1\n", 1 / height,
           o->samples - 1);
    print_mirrored("CENTER %.9g %.9g %.9g\n", s->eye);
    printf("VIEWDIR %.9g %.9g %.9g\nUPDIR 0 1 0\nEND_CAMERA\n", forward[0], forward[1], -forward[2]);
    print3("BACKGROUND %.9g %.9g %.9g\n", s->background);
    print_mirrored("LIGHT CENTER %.9g %.9g %.9g RAD 0.001 COLOR 1 1 1\n", s->light);
    for (int m = 0; m < s->material_count; m++) {
        const bench_material *p = &s->materials[m];
        printf("TEXDEF M%d AMBIENT %.9g DIFFUSE 1 SPECULAR 0 OPACITY 1 PHONG PLASTIC %.9g PHONG_SIZE %.9g", m,
               (double)s->ambient[1], (double)p->specular, (double)p->shininess);
        print3(" COLOR %.9g %.9g %.9g TEXFUNC 0\n", p->diffuse);
    }
    for (size_t i = 0; i < s->sphere_count; i++) {
        const float *p = s->spheres + 4 * i;
        print_mirrored("SPHERE CENTER %.9g %.9g %.9g", p);
        printf(" RAD %.9g M%u\n", (double)p[3], (unsigned)s->sphere_material[i]);
    }
    puts("END_SCENE");
}

int main(int argc, char **argv)
{
    bench_options options = bench_options_read(argc, argv);
    bench_scene scene;
    if (!bench_scene_create(options.scene, &scene))
        bench_fail(options.scene, "no such scene");
    if (strcmp(options.mode, "povray") == 0)
        write_povray(&scene, &options);
    else if (strcmp(options.mode, "tachyon") == 0)
        write_tachyon(&scene, &options);
    else
        bench_fail(options.mode, "povray or tachyon expected");
    bench_scene_free(&scene);
    return 0;
}
