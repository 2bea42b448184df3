/// Programs in two parts, and frames in which constants of programs change:
/// cached values give the same bits as a fresh frame.
#include "engine/film/image.h"
#include "engine/render/frame/renderer.h"
#include "engine/render/program/split.h"
#include "tests/engine/cases/program_case.h"

#include "tests/engine/cases/builder_case.h"

enum { CASES = 1500 };

// ---- Two parts ------------------------------------------------------------------------------------------------------

static long splits_seen, refused_seen;

/// Returns the program's constants, with new values for the constants that are marked in `changed`.
static double (*other_numbers(const glint_program *program, const bool *changed))[GLINT_NUMBER_LANES]
{
    double(*numbers)[GLINT_NUMBER_LANES] = input(KIND_DOUBLE, (program->number_count + 1) * GLINT_NUMBER_LANES);
    for (uint32_t i = 0; i < program->number_count; i++) {
        const double other = recipe_number(true);
        for (int k = 0; k < GLINT_NUMBER_LANES; k++)
            numbers[i][k] = changed[i] ? other : program->code.numbers[i][k];
    }
    return numbers;
}

/// Runs the first part with the old constants, then the second part with the new ones, into `args`, which has already
/// run the whole program.
static void run_parts(const glint_split *split, const glint_program *program, const glint_program_args *args)
{
    static _Alignas(64) double values[GLINT_PROGRAM_OUTPUTS_MAX][GLINT_PROGRAM_LANES];
    glint_program_code first = split->first, second = split->second;
    glint_program_args one = *args, two = *args;
    first.numbers = program->code.numbers;
    second.numbers = args->code->numbers;
    first.textures = second.textures = args->code->textures;
    one.code = &first;
    two.code = &second;
    for (uint32_t k = 0; k < GLINT_PROGRAM_OUTPUTS_MAX; k++)
        one.result[k] = k < first.output_count ? values[k] : NULL;
    running->program(&one);
    two.same = 0;
    for (uint32_t k = 0; k < first.output_count; k++) {
        two.input[k] = values[k];
        for (uint32_t i = 0; i < args->group_count * GLINT_GROUP && split->truths >> k & 1; i++)
            if (args->wanted[i / GLINT_GROUP] >> i % GLINT_GROUP & 1)
                assert_true(values[k][i] == 0 || values[k][i] == 1 || isnan(values[k][i]));
    }
    running->program(&two);
}

static void random_split(int precision, bool odd)
{
    (void)precision;
    const recipe r = random_recipe(odd);
    glint_program *program = recipe_build(&r, false);
    const uint32_t groups = 1 + below(GLINT_PROGRAM_GROUPS);
    glint_program_args args = program_inputs(program, groups, odd);
    glint_program_code code = program->code;
    bool *changed = input(KIND_U16, program->number_count + 1);
    glint_split *split;
    for (uint32_t i = 0; i < program->number_count; i++)
        changed[i] = one_in(3);
    assert_true(glint_split_create(program, changed, &split));
    code.numbers = (const double(*)[GLINT_NUMBER_LANES])other_numbers(program, changed);
    args.code = &code;
    args.wanted = masks(groups);
    args.rows = input(KIND_DOUBLE, (program->code.row_count + GLINT_PROGRAM_OUTPUTS_MAX) * GLINT_PROGRAM_LANES);
    splits_seen += split != NULL;
    refused_seen += split == NULL;
    if (split) {
        assert_in_range(split->first.row_count, 0, program->code.row_count + GLINT_PROGRAM_OUTPUTS_MAX);
        assert_in_range(split->second.row_count, 0, program->code.row_count);
    }
    FOR_EACH_TESTED
    {
        for (uint32_t k = 0; k < code.output_count; k++)
            args.result[k] = output("result", KIND_DOUBLE, groups * GLINT_GROUP);
        if (split && running != &glint_stages_ref)
            run_parts(split, program, &args);
        else
            running->program(&args);
        compare_outputs("split");
        for (uint32_t k = 0; k < code.output_count; k++)
            args.result[k] = output("result", KIND_DOUBLE, groups * GLINT_GROUP);
        if (split)
            run_parts(split, program, &args);
        else
            running->program(&args);
        compare_outputs("split");
    }
    glint_split_destroy(split);
    glint_program_release(program);
}

static void test_random_splits(void **state)
{
    (void)state;
    run_cases(CASES, 61000, random_split);
    assert_true(splits_seen > CASES / 4 / case_step() && refused_seen > 0);
}

static glint_value of_point(glint_op which) { return op(which, in(GLINT_INPUT_P_X), in(GLINT_INPUT_P_Y), in(GLINT_INPUT_P_Z)); }

/// Splits a program in which the constant `which` changes. Returns NULL when no split is possible.
static glint_split *split_by(const glint_value *outputs, size_t count, double which, glint_program **program)
{
    bool changed[32] = { false };
    glint_split *split;
    *program = end_program(outputs, count);
    for (uint32_t i = 0; i < (*program)->number_count; i++)
        changed[i] = (*program)->code.numbers[i][0] == which;
    assert_true(glint_split_create(*program, changed, &split));
    return split;
}

/// A checkerboard with a changing colour: one bit is cached, and all selections run again, even the unchanged ones.
static void test_board(void **state)
{
    (void)state;
    glint_value out[3];
    glint_program *program;
    begin_program(GLINT_PROGRAM_PATTERN);
    const glint_value odd = of_point(GLINT_OP_PARITY);
    for (int c = 0; c < 3; c++)
        out[c] = op(GLINT_OP_SELECT, odd, num(0.1 * c), num(0.9));
    glint_split *split = split_by(out, 3, 0.1 * 2, &program);
    assert_int_equal(split->first.output_count, 1);
    assert_int_equal(split->truths, 1);
    assert_int_equal(split->first.length, 1);
    assert_int_equal(split->second.length, 3);
    glint_split_destroy(split);
    glint_program_release(program);
}

/// Marble with changing colours: its noise is cached as one number, not as the three mixed results.
static void test_marble(void **state)
{
    (void)state;
    glint_value out[3];
    glint_program *program;
    begin_program(GLINT_PROGRAM_PATTERN);
    const glint_value share = op(GLINT_OP_SIN, op(GLINT_OP_MUL, of_point(GLINT_OP_NOISE), num(5), 0), 0, 0);
    for (int c = 0; c < 3; c++)
        out[c] = op(GLINT_OP_MIX, num(0.25 * c), num(0.9), share);
    glint_split *split = split_by(out, 3, 0.25, &program);
    assert_int_equal(split->first.output_count, 1);
    assert_int_equal(split->truths, 0);
    assert_int_equal(split->first.length, 3);
    assert_int_equal(split->second.length, 3);
    assert_true(split->cost < split->saved);
    glint_split_destroy(split);
    glint_program_release(program);
}

/// When a scale changes, the split would cache the whole point and save nothing. Constants are never cached.
static void test_scale(void **state)
{
    (void)state;
    glint_value p[3], out[1];
    glint_program *program;
    begin_program(GLINT_PROGRAM_PATTERN);
    for (int c = 0; c < 3; c++)
        p[c] = op(GLINT_OP_MUL, in((glint_input)(GLINT_INPUT_P_X + c)), num(3), 0);
    out[0] = op(GLINT_OP_PARITY, p[0], p[1], p[2]);
    glint_split *split = split_by(out, 1, 3, &program);
    assert_int_equal(split->first.output_count, 3);
    assert_int_equal(split->saved, 0);
    glint_split_destroy(split);
    glint_program_release(program);
    begin_program(GLINT_PROGRAM_PATTERN);
    out[0] = num(3);
    assert_null(split_by(out, 1, 3, &program));
    glint_program_release(program);
}

// ---- Frames ---------------------------------------------------------------------------------------------------------

enum { MATERIALS = 3, FIELDS = 7 };

/// The recipes of a material's fields. A field without steps has no program.
typedef struct dressed {
    glint_material *material;
    recipe field[FIELDS];
} dressed;

typedef struct world {
    glint_scene *scene;
    glint_render_desc render;
    glint_light *light;
    dressed of[MATERIALS];
} world;

static void add_op(recipe *r, glint_op which, uint32_t a, uint32_t b, uint32_t c)
{
    recipe_add(r, (recipe_step) { .op = which, .operand = { a, b, c } }, glint_op_info_of(which)->results);
}

static uint32_t add_number(recipe *r, double x)
{
    recipe_add(r, (recipe_step) { .op = (glint_op)GLINT_SSA_NUMBER, .number = x }, 1);
    return r->value_count - 1;
}

/// Makes a random program whose results are between 0 and 1, except for special values.
static recipe any_field(bool one)
{
    recipe r;
    do
        r = random_recipe(false);
    while (r.step_count > RECIPE_STEPS - 17);
    r.output_count = one ? 1 : r.output_count;
    const uint32_t half = add_number(&r, 0.45);
    for (uint32_t k = 0; k < r.output_count; k++) {
        add_op(&r, GLINT_OP_SIN, r.output[k], 0, 0);
        const uint32_t wave = r.value_count - 1, scale = add_number(&r, between(0.1, 0.4));
        add_op(&r, GLINT_OP_MULADD, wave, scale, half);
        if (!one_in(4)) { // without this, the result may be NaN; `less` selects one of two numbers
            add_op(&r, GLINT_OP_LESS, half, r.value_count - 1, 0);
            add_op(&r, GLINT_OP_SELECT, r.value_count - 1, scale, half);
        }
        r.output[k] = r.value_count - 1;
    }
    return r;
}

/// A typical pattern: checkers, bands or noise of a scaled point, in two colours; sometimes NaN on one side of a line.
static recipe usual_field(bool one)
{
    recipe r = { .output_count = one ? 1 : 3 };
    uint32_t p[3];
    for (uint32_t i = 0; i < 3; i++)
        recipe_add(&r, (recipe_step) { .op = (glint_op)GLINT_SSA_INPUT, .operand = { GLINT_INPUT_P_X + i } }, 1);
    const uint32_t scale = add_number(&r, between(0.5, 5));
    for (uint32_t i = 0; i < 3; i++) {
        add_op(&r, GLINT_OP_MUL, i, scale, 0);
        p[i] = r.value_count - 1;
    }
    if (one_in(5)) {
        add_op(&r, GLINT_OP_SQRT, p[0], 0, 0);
        p[0] = r.value_count - 1;
    }
    const uint32_t kind = below(3);
    add_op(&r, kind ? GLINT_OP_PARITY : GLINT_OP_NOISE, p[0], p[1], p[2]);
    if (kind == 1)
        add_op(&r, GLINT_OP_LESS, p[1], r.value_count - 1, 0);
    const uint32_t share = r.value_count - 1;
    for (uint32_t k = 0; k < r.output_count; k++) {
        const uint32_t a = add_number(&r, between(0, 0.5)), b = add_number(&r, between(0.5, 1));
        if (kind)
            add_op(&r, GLINT_OP_SELECT, share, a, b);
        else
            add_op(&r, GLINT_OP_MIX, a, b, share);
        r.output[k] = r.value_count - 1;
    }
    return r;
}

static recipe random_field(bool one) { return one_in(4) ? any_field(one) : usual_field(one); }

static void set_programs(dressed *d)
{
    glint_material_desc desc = *glint_material_get(d->material);
    desc.struct_size = sizeof desc;
    glint_program **const at[FIELDS] = { &desc.program.diffuse,   &desc.program.specular, &desc.program.shininess,
                                         &desc.program.roughness, &desc.program.mirror,   &desc.program.bump,
                                         &desc.program.opacity };
    for (int i = 0; i < FIELDS; i++)
        *at[i] = d->field[i].step_count ? recipe_build(&d->field[i], false) : NULL;
    OK(glint_material_set(d->material, &desc, &error));
    for (int i = 0; i < FIELDS; i++)
        glint_program_release(*at[i]);
}

static void random_dress(dressed *d)
{
    glint_material_desc desc = glint_material_desc_default();
    desc.model = (glint_model)below(4);
    desc.normalized = one_in(2);
    desc.has_ambient = one_in(3);
    for (int c = 0; c < 3; c++)
        desc.specular[c] = between(0, 1);
    OK(glint_material_create(&desc, &d->material, &error));
    memset(d->field, 0, sizeof d->field);
    d->field[0] = random_field(false);
    for (int i = 1; i < FIELDS; i++)
        if (one_in(i < 3 ? 2 : i < 4 ? 3 : 8))
            d->field[i] = random_field(i != 1 && i != 4);
    set_programs(d);
}

static void add_shape(world *w, glint_shape_kind kind, double x, glint_material *material)
{
    glint_shape_desc desc = glint_shape_desc_default(kind);
    const double to[3] = { x, 1, -x };
    glint_shape *shape;
    if (kind != GLINT_SHAPE_PLANE) // a plane stays at y = 0, so that p.y is the same number for all points
        desc.transform = glint_transform_translate(to);
    desc.material = material;
    OK(glint_shape_create(&desc, &shape, &error));
    OK(glint_scene_add_shape(w->scene, shape, &error));
    glint_shape_release(shape);
}

static void aim(world *w, double x)
{
    glint_camera_desc desc = glint_camera_desc_default();
    glint_scene_desc scene = *glint_scene_get(w->scene);
    scene.struct_size = sizeof scene;
    const double eye[3] = { x, 3, 7 };
    glint_camera *camera;
    memcpy(desc.eye, eye, sizeof eye);
    OK(glint_camera_create(&desc, &camera, &error));
    scene.camera = camera;
    OK(glint_scene_set(w->scene, &scene, &error));
    glint_camera_release(camera);
}

static void random_world(world *w)
{
    static const glint_shape_kind kinds[MATERIALS] = { GLINT_SHAPE_PLANE, GLINT_SHAPE_SPHERE, GLINT_SHAPE_BOX };
    glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_POINT);
    const double position[3] = { 3, 8, 5 };
    OK(glint_scene_create(&w->scene, &error));
    aim(w, 1);
    for (int i = 0; i < MATERIALS; i++) {
        random_dress(&w->of[i]);
        add_shape(w, kinds[i], 2.5 * i - 2.5, w->of[i].material);
    }
    memcpy(light.position, position, sizeof position);
    OK(glint_light_create(&light, &w->light, &error));
    OK(glint_scene_add_light(w->scene, w->light, &error));
    glint_scene_desc scene = *glint_scene_get(w->scene);
    scene.struct_size = sizeof scene;
    scene.ambient[0] = scene.ambient[1] = scene.ambient[2] = 0.1;
    scene.has_indirect = one_in(6);
    scene.indirect_samples = scene.indirect_bounces = scene.reflection_samples = 1;
    OK(glint_scene_set(w->scene, &scene, &error));
    w->render = glint_render_desc_default();
    w->render.width = 72;
    w->render.height = 53;
    w->render.samples = one_in(3) ? 3 : 1;
    w->render.adaptive = one_in(6) ? 0.1 : 0;
    w->render.precision = one_in(4) ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE;
    w->render.passes = 1u << GLINT_PASS_BEAUTY | (one_in(3) ? 1u << GLINT_PASS_ALBEDO : 0);
}

static void release_world(world *w)
{
    for (int i = 0; i < MATERIALS; i++)
        glint_material_release(w->of[i].material);
    glint_light_release(w->light);
    glint_scene_release(w->scene);
}

/// Changes a constant of one field. Successive frames change the same constant, as a user turning a knob would.
static void turn_knob(world *w, uint32_t knob)
{
    dressed *d = &w->of[knob % MATERIALS];
    recipe *r = &d->field[knob / MATERIALS % FIELDS];
    r = r->step_count ? r : &d->field[0];
    uint32_t number = knob / (MATERIALS * FIELDS) % 8; // index of the constant, counted from the end
    for (uint32_t i = r->step_count; i-- > 0;)
        if (r->step[i].op == (glint_op)GLINT_SSA_NUMBER && number-- == 0)
            r->step[i].number += between(0.001, 0.02);
    set_programs(d);
}

static void change(world *w, uint32_t *knob)
{
    const uint32_t kind = below(16);
    if (kind == 0)
        aim(w, between(-1, 1));
    if (kind == 1) {
        glint_light_desc light = *glint_light_get(w->light);
        light.struct_size = sizeof light;
        light.position[0] += 0.5;
        OK(glint_light_set(w->light, &light, &error));
    }
    if (kind == 2) {
        w->of[1].field[0] = random_field(false);
        set_programs(&w->of[1]);
    }
    if (kind <= 2)
        *knob = below(100000);
    if (kind == 4 || kind == 5) // the constant alternates between two values
        *knob ^= MATERIALS * FIELDS;
    if (kind == 3)
        turn_knob(w, *knob + 1 + below(1000));
    if (kind != 6)
        turn_knob(w, *knob);
}

static glint_image *render(glint_renderer *renderer, const world *w, glint_frame_stats *stats)
{
    glint_plan *plan;
    glint_image *image;
    OK(glint_plan_create(w->scene, &w->render, &plan, &error));
    OK(glint_render(renderer, plan, &image, stats, &error));
    glint_plan_destroy(plan);
    return image;
}

static void check_same(const glint_image *a, const glint_image *b, uint32_t round, uint32_t frame)
{
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        for (int c = 0; c < glint_pass_channels((glint_pass)pass); c++)
            if (a->plane[pass][c] &&
                memcmp(a->plane[pass][c], b->plane[pass][c], sizeof(float) * (size_t)(a->width * a->height)) != 0)
                fail_msg("round %u, frame %u: pass %s differs", round, frame, glint_pass_name((glint_pass)pass));
}

/// Counts the tiles of the last frame with cached results of first parts.
static long kept_tiles(const glint_renderer *renderer)
{
    const glint_reuse *reuse = &renderer->reuse;
    long count = 0;
    for (size_t i = 0; i < reuse->tile_count; i++)
        count += glint_splits_are_on(&reuse->splits) && glint_key_equal(reuse->tiles[i].split, reuse->splits.key);
    return count;
}

static glint_renderer *new_renderer(const char *isa, bool fresh)
{
    glint_renderer_desc desc = { .struct_size = sizeof(glint_renderer_desc), .isa = isa, .threads = 1 + (int)below(3), .no_reuse = fresh };
    glint_renderer *renderer;
    if (!fresh && one_in(4))
        desc.reuse_memory = 20000 + below(400000); // only part of the cached values fits
    OK(glint_renderer_create(&desc, &renderer, &error));
    return renderer;
}

/// Frames of random programs with changing constants:
/// every instruction set in turn, one or several threads, and little memory.
static void test_frames(void **state)
{
    (void)state;
    long kept = 0;
    for (uint32_t round = 0; round < 120; round += case_step()) {
        world w;
        uint32_t knob = 0;
        random_state = 4100 + round;
        random_world(&w);
        const glint_stages *isa = tested[round % tested_count];
        glint_renderer *keeping = new_renderer(isa->name, false), *fresh = new_renderer(isa->name, true);
        for (uint32_t frame = 0; frame < 14; frame++) {
            glint_image *a = render(keeping, &w, NULL), *b = render(fresh, &w, NULL);
            check_same(a, b, round, frame);
            kept += kept_tiles(keeping);
            glint_image_release(a);
            glint_image_release(b);
            change(&w, &knob);
        }
        glint_renderer_destroy(keeping);
        glint_renderer_destroy(fresh);
        release_world(&w);
    }
    assert_true(kept > 2000 / (long)case_step());
}

enum { SCALE = 6, COLOR = 11 }; // steps of a checkerboard's recipe

/// A world in which only the floor has a program: a checkerboard of world + scale p.
static recipe *board_world(world *w)
{
    random_state = 5;
    random_world(w);
    w->render.samples = 1;
    w->render.adaptive = 0;
    for (int i = 0; i < MATERIALS * FIELDS; i++)
        w->of[i / FIELDS].field[i % FIELDS] = (recipe) { .step_count = 0 };
    recipe *r = &w->of[0].field[0];
    for (uint32_t i = 0; i < 6; i++)
        recipe_add(r, (recipe_step) { .op = (glint_op)GLINT_SSA_INPUT, .operand = { GLINT_INPUT_P_X + i } }, 1);
    add_number(r, 2);
    for (uint32_t i = 0; i < 3; i++)
        add_op(r, GLINT_OP_MULADD, i, SCALE, 3 + i);
    add_op(r, GLINT_OP_PARITY, 7, 8, 9);
    add_number(r, 0.5);
    add_op(r, GLINT_OP_SELECT, 10, COLOR, add_number(r, 0.75));
    r->output[r->output_count++] = r->value_count - 1;
    set_programs(&w->of[1]);
    set_programs(&w->of[2]);
    return r;
}

/// Changes the constants of a checkerboard in turn. A changing scale would need too much memory for the cache. When
/// the colour changes afterwards, the cached values belong to another scale. A negative colour is reported as usual.
static void test_turns(void **state)
{
    (void)state;
    static const struct { uint32_t step; double number; bool kept; } turns[] = {
        { COLOR, 0.5, false },   { COLOR, 0.4, true },   { COLOR, 0.3, true }, { SCALE, 3, false },
        { COLOR, 0.25, true },   { COLOR, -0.25, true }, { COLOR, 0.2, true }, { SCALE, 2, false },
        { COLOR, -0.125, false }, { COLOR, 0.2, true },
    };
    world w;
    recipe *r = board_world(&w);
    glint_renderer_desc desc = { .struct_size = sizeof(glint_renderer_desc), .threads = 2 };
    glint_renderer *keeping, *fresh = new_renderer(NULL, true);
    OK(glint_renderer_create(&desc, &keeping, &error));
    for (uint32_t i = 0; i < COUNT_OF(turns); i++) {
        glint_frame_stats stats[2];
        r->step[turns[i].step].number = turns[i].number;
        set_programs(&w.of[0]);
        glint_image *a = render(keeping, &w, &stats[0]), *b = render(fresh, &w, &stats[1]);
        check_same(a, b, 0, i);
        const glint_odd *odd = stats[0].odd, *other = stats[1].odd;
        assert_true(odd[GLINT_ODD_NAN].count == 0 && odd[GLINT_ODD_HUGE].count == 0);
        assert_int_equal(odd[GLINT_ODD_NEGATIVE].count, other[GLINT_ODD_NEGATIVE].count);
        assert_int_equal(odd[GLINT_ODD_NEGATIVE].count > 0, turns[i].number < 0);
        assert_memory_equal(odd[GLINT_ODD_NEGATIVE].point, other[GLINT_ODD_NEGATIVE].point, sizeof odd->point);
        assert_int_equal(kept_tiles(keeping) > 0, turns[i].kept);
        glint_image_release(a);
        glint_image_release(b);
    }
    glint_renderer_destroy(keeping);
    glint_renderer_destroy(fresh);
    release_world(&w);
}

/// A normalised highlight's colour is multiplied by a factor of its exponent: only the values before that are cached.
static void test_normalized(void **state)
{
    (void)state;
    world w;
    recipe *field = board_world(&w);
    glint_material_desc desc = *glint_material_get(w.of[0].material);
    desc.struct_size = sizeof desc;
    desc.model = GLINT_MODEL_PHONG;
    desc.normalized = true;
    OK(glint_material_set(w.of[0].material, &desc, &error));
    field[1] = field[2] = field[0];
    glint_renderer_desc options = { .struct_size = sizeof(glint_renderer_desc), .threads = 1 };
    glint_renderer *keeping, *fresh = new_renderer(NULL, true);
    OK(glint_renderer_create(&options, &keeping, &error));
    for (uint32_t i = 0; i < 8; i++) {
        field[i < 4 ? 2 : 1].step[COLOR].number += 0.01;
        set_programs(&w.of[0]);
        glint_image *a = render(keeping, &w, NULL), *b = render(fresh, &w, NULL);
        check_same(a, b, 0, i);
        assert_int_equal(kept_tiles(keeping) > 0, i > 0);
        glint_image_release(a);
        glint_image_release(b);
    }
    glint_renderer_destroy(keeping);
    glint_renderer_destroy(fresh);
    release_world(&w);
}

int main(void)
{
    find_tested();
    print_skipped();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_splits), cmocka_unit_test(test_board),  cmocka_unit_test(test_marble),
        cmocka_unit_test(test_scale),         cmocka_unit_test(test_frames),
        cmocka_unit_test(test_turns),         cmocka_unit_test(test_normalized),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
