/// Charts: positions of curves, numbers and labels, as marks on a page.
#include "tests/engine/cases/image_case.h"

#include "engine/figures/ink/ink.h"
#include "engine/figures/overlay/overlay.h"

#include <math.h>

#define WIDTH 400
#define HEIGHT 300

typedef struct page {
    glint_ink ink;
    glint_chart *chart;
} page;

/// Draws a chart with letters of 13 pixels.
static page draw(const glint_curve *curves, size_t count, glint_overlay_desc desc)
{
    page p;
    glint_error error;
    glint_overlays *overlays = calloc(1, sizeof *overlays + sizeof *overlays->of);
    assert_non_null(overlays);
    assert_int_equal(glint_chart_create(curves, count, &p.chart, &error), GLINT_OK);
    assert_int_equal(glint_ink_open(WIDTH, HEIGHT, &p.ink, &error), GLINT_OK);
    overlays->scale = overlays->enlarged = 1;
    overlays->width = WIDTH;
    overlays->height = HEIGHT;
    overlays->count = 1;
    desc.chart = p.chart;
    desc.has_size = true;
    desc.size = 13;
    overlays->of[0] = desc;
    assert_int_equal(glint_overlays_draw(overlays, 0, &p.ink, &error), GLINT_OK);
    free(overlays);
    return p;
}

static void drop(page *p)
{
    glint_ink_close(&p->ink);
    glint_chart_release(p->chart);
}

static const glint_ink_mark *find_text(const page *p, const char *text)
{
    for (size_t i = 0; i < p->ink.count; i++)
        if (p->ink.of[i].kind == GLINT_MARK_TEXT && strcmp(p->ink.of[i].text, text) == 0)
            return &p->ink.of[i];
    fail_msg("no text '%s'", text);
    return NULL;
}

/// Returns stroke mark number `number`, from 0.
static const glint_ink_mark *find_strokes(const page *p, int number)
{
    for (size_t i = 0; i < p->ink.count; i++)
        if (p->ink.of[i].kind == GLINT_MARK_STROKES && number-- == 0)
            return &p->ink.of[i];
    return NULL;
}

static double middle_x(const glint_ink_mark *text) { return text->box.x + text->box.width / 2.0; }
static double middle_y(const glint_ink_mark *text) { return text->box.y + text->typeface.height / 2.0; }

/// The points of a curve are where the numbers of the axes put them, and everything lies on the page.
static void test_positions(void **state)
{
    (void)state;
    static const double x[] = { 0, 10, 20 }, y[] = { 1, 2, 1.5 };
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_CHART);
    desc.has_range[1] = true;
    desc.range[1][0] = 1;
    desc.range[1][1] = 2;
    strcpy(desc.titles[0], "angle");
    strcpy(desc.titles[1], "share");
    strcpy(desc.text, "title");
    page p = draw(&(glint_curve) { .x = x, .y = y, .count = 3, .label = "curve" }, 1, desc);
    const glint_strokes *s = &find_strokes(&p, 0)->strokes;
    assert_int_equal(s->count, 2);
    const glint_stroke *first = &s->of[0], *last = &s->of[1];
    assert_true(fabs(first->from[0] - middle_x(find_text(&p, "0"))) <= 1);
    assert_true(fabs(last->from[0] - middle_x(find_text(&p, "10"))) <= 1);
    assert_true(fabs(last->from[0] + last->offset[0] - middle_x(find_text(&p, "20"))) <= 1);
    assert_true(fabs(first->from[1] - middle_y(find_text(&p, "1.00"))) <= 1.5);
    assert_true(fabs(last->from[1] - middle_y(find_text(&p, "2.00"))) <= 1.5);
    assert_true(fabs(last->from[1] + last->offset[1] - middle_y(find_text(&p, "1.50"))) <= 1.5);
    assert_true(fabs(last->from[1] + last->offset[1] - middle_y(find_text(&p, "curve"))) <= 1.5);
    assert_true(find_text(&p, "curve")->box.x > last->from[0] + last->offset[0]);
    assert_true(find_text(&p, "title")->box.y < last->from[1] && find_text(&p, "angle")->box.y > middle_y(find_text(&p, "10")));
    assert_int_equal(find_text(&p, "share")->turn, GLINT_UP);
    for (size_t i = 0; i < p.ink.count; i++) {
        const glint_rect *box = &p.ink.of[i].box;
        if (p.ink.of[i].kind != GLINT_MARK_STROKES)
            assert_true(box->x >= 0 && box->y >= 0 && box->x + box->width <= WIDTH && box->y + box->height <= HEIGHT);
    }
    drop(&p);
}

/// Equal factors are equal distances on logarithmic axes.
static void test_logarithmic(void **state)
{
    (void)state;
    static const double x[] = { 1, 10, 1000 }, y[] = { 1, 0.1, 0.001 };
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_CHART);
    desc.is_log_axis[0] = desc.is_log_axis[1] = true;
    page p = draw(&(glint_curve) { .x = x, .y = y, .count = 3, .label = "" }, 1, desc);
    const glint_strokes *s = &find_strokes(&p, 0)->strokes;
    for (int i = 0; i < 2; i++)
        assert_true(fabs(s->of[1].offset[i] - 2 * s->of[0].offset[i]) < 1e-9 && s->of[0].offset[i] > 1);
    assert_true(fabs(s->of[1].from[0] - middle_x(find_text(&p, "10"))) <= 1);
    assert_true(fabs(s->of[1].from[1] - middle_y(find_text(&p, "0.1"))) <= 1.5);
    drop(&p);
}

/// NaN makes a gap. A point between two gaps is a dot, and with has_dots every point is.
static void test_gaps(void **state)
{
    (void)state;
    static const double x[] = { 1, 2, 3, 4, 5, 6, 7 }, y[] = { 1, 2, NAN, 3, NAN, 1, 2 };
    const glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_CHART);
    for (int dots = 0; dots < 2; dots++) {
        page p = draw(&(glint_curve) { .x = x, .y = y, .count = 7, .label = "", .has_dots = dots }, 1, desc);
        assert_int_equal(find_strokes(&p, 0)->strokes.count, 2);
        assert_int_equal(find_strokes(&p, 1)->strokes.count, dots ? 5 : 1);
        assert_true(find_strokes(&p, 1)->strokes.half > find_strokes(&p, 0)->strokes.half);
        assert_null(find_strokes(&p, 2));
        drop(&p);
    }
    page p = draw(&(glint_curve) { .x = x, .y = y, .count = 7, .label = "", .has_width = true, .has_dots = true }, 1, desc);
    assert_int_equal(find_strokes(&p, 0)->strokes.count, 5);
    assert_null(find_strokes(&p, 1));
    drop(&p);
}

/// Labels have the colours of their curves and are at least a line apart, in the order of the curves' ends.
static void test_labels(void **state)
{
    (void)state;
    static const double x[] = { 0, 1 }, y[4][2] = { { 0, 0 }, { 0, 0.01 }, { 1, -0.01 }, { 5, 9 } };
    static const char *const names[] = { "a", "b", "c", "d" };
    glint_curve curves[4];
    for (int i = 0; i < 4; i++)
        curves[i] = (glint_curve) { .x = x, .y = y[i], .count = 2, .label = names[i] };
    page p = draw(curves, 4, glint_overlay_desc_default(GLINT_OVERLAY_CHART));
    static const char *const from_below[] = { "c", "a", "b", "d" };
    for (int i = 0; i < 4; i++) {
        const glint_ink_mark *text = find_text(&p, names[i]), *strokes = find_strokes(&p, i);
        assert_memory_equal(text->color, strokes->color, sizeof text->color);
        if (i > 0)
            assert_true(find_text(&p, from_below[i - 1])->box.y - find_text(&p, from_below[i])->box.y >= text->typeface.line - 1);
    }
    drop(&p);
}

/// A point outside the range is outside the area of the curves, to which the strokes are clipped.
static void test_clipped(void **state)
{
    (void)state;
    static const double x[] = { 0, 1, 2 }, y[] = { 0, 1e300, 1 };
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_CHART);
    desc.has_range[1] = true;
    desc.range[1][1] = 2;
    page p = draw(&(glint_curve) { .x = x, .y = y, .count = 3, .label = "" }, 1, desc);
    const glint_ink_mark *mark = find_strokes(&p, 0);
    assert_true(mark->clip.y > 0 && mark->clip.x > 0 && mark->clip.y + mark->clip.height < HEIGHT);
    assert_true(mark->strokes.of[1].from[1] < -1000 && isfinite(mark->strokes.of[1].from[1]));
    drop(&p);
}

static void test_refuses(void **state)
{
    (void)state;
    static const double x[] = { 1 };
    const glint_curve curve = { .x = x, .y = x, .count = 1, .label = "" };
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_CHART);
    glint_chart *chart = NULL;
    glint_overlay *overlay = NULL;
    glint_error error;
    assert_int_equal(glint_chart_create(&curve, 0, &chart, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "series: 1 .. 16 curves expected, got 0");
    assert_int_equal(glint_overlay_create(&desc, &overlay, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "series: curves expected, got NULL");
}

/// An overlay retains its chart, and releases it when another chart is set.
static void test_kept(void **state)
{
    (void)state;
    static const double x[] = { 1 }, y[] = { 2 };
    glint_curve curve = { .x = x, .y = x, .count = 1, .label = "a" };
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_CHART);
    glint_overlay *overlay = NULL;
    glint_error error;
    assert_int_equal(glint_chart_create(&curve, 1, &desc.chart, &error), GLINT_OK);
    assert_int_equal(glint_overlay_create(&desc, &overlay, &error), GLINT_OK);
    glint_chart_release(desc.chart);
    assert_string_equal(glint_chart_curve(glint_overlay_get(overlay)->chart, 0)->label, "a");
    desc = *glint_overlay_get(overlay);
    desc.struct_size = sizeof desc;
    assert_int_equal(glint_overlay_set(overlay, &desc, &error), GLINT_OK); // the same chart again
    curve.y = y;
    assert_int_equal(glint_chart_create(&curve, 1, &desc.chart, &error), GLINT_OK);
    assert_int_equal(glint_overlay_set(overlay, &desc, &error), GLINT_OK);
    glint_chart_release(desc.chart);
    assert_true(glint_chart_curve(glint_overlay_get(overlay)->chart, 0)->y[0] == 2);
    glint_overlay_release(overlay);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_positions), cmocka_unit_test(test_logarithmic), cmocka_unit_test(test_gaps),
        cmocka_unit_test(test_labels),    cmocka_unit_test(test_clipped),     cmocka_unit_test(test_refuses),
        cmocka_unit_test(test_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
