#include "engine/figures/overlay/curves.h"

#include "engine/base/status.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define POINTS_MAX ((size_t)1000000) ///< most points of a curve

struct glint_chart {
    atomic_int references;
    size_t count;
    glint_curve of[]; ///< followed by the points and the labels
};

static glint_status check_curve(const glint_curve *curve, size_t number, glint_error *error)
{
    size_t shown = 0;
    if (curve->count < 1 || curve->count > POINTS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "series[%zu]: 1 .. %zu points expected, got %zu", number, POINTS_MAX, curve->count);
    for (size_t i = 0; i < curve->count; i++) {
        const double x = curve->x[i], y = curve->y[i];
        if (isinf(x) || isinf(y))
            return glint_fail(error, GLINT_ERR_INVALID, "series[%zu].%c[%zu]: finite number, or NaN for a gap, expected, got %g", number,
                              isinf(x) ? 'x' : 'y', i + 1, isinf(x) ? x : y);
        shown += !isnan(x) && !isnan(y);
    }
    if (!shown)
        return glint_fail(error, GLINT_ERR_INVALID, "series[%zu]: at least one point that is not NaN expected", number);
    if (strlen(curve->label) >= GLINT_CHART_TEXT_SIZE)
        return glint_fail(error, GLINT_ERR_INVALID, "series[%zu].label: at most %d bytes expected", number, GLINT_CHART_TEXT_SIZE - 1);
    if (curve->has_width && !(curve->width >= 0 && curve->width <= 1000))
        return glint_fail(error, GLINT_ERR_INVALID, "series[%zu].width: points 0 .. 1000 expected, got %g", number, curve->width);
    return GLINT_OK;
}

/// Copies a curve's points and label to `at`. Returns the end of the copies.
static char *copy_curve(glint_curve *curve, char *at)
{
    const size_t bytes = curve->count * sizeof *curve->x, label = (strlen(curve->label) / sizeof(double) + 1) * sizeof(double);
    curve->x = memcpy(at, curve->x, bytes);
    curve->y = memcpy(at + bytes, curve->y, bytes);
    curve->label = strcpy(at + 2 * bytes, curve->label);
    return at + 2 * bytes + label;
}

glint_status glint_chart_create(const glint_curve *curves, size_t count, glint_chart **out, glint_error *error)
{
    GLINT_REFUSE_NULL(curves, error);
    GLINT_REFUSE_NULL(out, error);
    size_t size = sizeof **out + count * sizeof *curves;
    if (count < 1 || count > GLINT_CURVES_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "series: 1 .. %d curves expected, got %zu", GLINT_CURVES_MAX, count);
    for (size_t i = 0; i < count; i++) {
        const glint_status status = check_curve(&curves[i], i + 1, error);
        if (status)
            return status;
        size += (2 * curves[i].count + strlen(curves[i].label) / sizeof(double) + 1) * sizeof(double);
    }
    glint_chart *chart = malloc(size);
    if (!chart)
        return glint_fail_nomem(error);
    atomic_init(&chart->references, 1);
    chart->count = count;
    char *at = (char *)&chart->of[count];
    for (size_t i = 0; i < count; i++) {
        chart->of[i] = curves[i];
        at = copy_curve(&chart->of[i], at);
    }
    *out = chart;
    return GLINT_OK;
}

glint_chart *glint_chart_retain(glint_chart *chart)
{
    if (chart)
        atomic_fetch_add_explicit(&chart->references, 1, memory_order_relaxed);
    return chart;
}

void glint_chart_release(glint_chart *chart)
{
    if (chart && atomic_fetch_sub_explicit(&chart->references, 1, memory_order_acq_rel) == 1)
        free(chart);
}

const glint_curve *glint_chart_curve(const glint_chart *chart, size_t i) { return chart && i < chart->count ? &chart->of[i] : NULL; }

glint_key glint_chart_key(const glint_chart *chart, glint_key key)
{
    for (size_t i = 0; i < chart->count; i++) {
        const glint_curve *c = &chart->of[i];
        const double look[] = { (double)c->count, c->has_color, c->has_color ? c->color[0] : 0, c->has_color ? c->color[1] : 0,
                                c->has_color ? c->color[2] : 0, c->has_width, c->width, c->has_dots };
        key = glint_key_add(key, look, sizeof look);
        key = glint_key_add(glint_key_add(key, c->x, c->count * sizeof *c->x), c->y, c->count * sizeof *c->y);
        key = glint_key_add_string(key, c->label);
    }
    return key;
}
