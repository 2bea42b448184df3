/// Differences between two pictures, with the statistics of OpenImageIO's idiff.
#include "engine/base/status.h"
#include "engine/files/picture/file.h"
#include "engine/files/picture/pfm.h"
#include "engine/files/picture/png.h"
#include "engine/files/picture/write.h"
#include "engine/glint_compare.h"
#include "engine/glint_math.h"

#include <math.h>

/// A picture of either format; one of the two pointers is NULL.
typedef struct picture {
    int width, height, channels;
    int bits; ///< bits of each integer pixel value
    void *codes;
    float *values;
} picture;

static void free_picture(picture *p)
{
    free(p->codes);
    free(p->values);
}

static glint_status decode(const glint_bytes *bytes, glint_file_kind kind, picture *out, glint_error *error)
{
    glint_png png;
    glint_pfm pfm;
    glint_status status;
    if (kind == GLINT_FILE_PNG) {
        status = glint_png_decode(bytes->data, bytes->size, &png, error);
        if (!status)
            *out = (picture) { png.width, png.height, png.channels, png.bits, png.codes, NULL };
    } else {
        status = glint_pfm_decode(bytes->data, bytes->size, &pfm, error);
        if (!status)
            *out = (picture) { pfm.width, pfm.height, pfm.channels, 0, NULL, pfm.values };
    }
    return status;
}

static glint_status load(const char *path, picture *out, glint_error *error)
{
    glint_file_kind kind;
    glint_bytes bytes = { 0 };
    glint_error inner;
    glint_status status = glint_file_kind_read(path, &kind, error);
    if (!status)
        status = glint_file_read_picture(path, &bytes, error);
    if (status == GLINT_ERR_INVALID) { // here the only cause is that the sizes differ
        status = GLINT_ERR_FORMAT;
        if (error)
            error->status = status;
    }
    if (status)
        return status;
    status = decode(&bytes, kind, out, &inner);
    free(bytes.data);
    return status ? glint_fail(error, status, "%.300s: %.200s", path, inner.message) : GLINT_OK;
}

static double value_at(const picture *p, size_t i)
{
    if (p->values)
        return p->values[i];
    return p->bits == 16 ? ((const uint16_t *)p->codes)[i] / 65535.0 : ((const uint8_t *)p->codes)[i] / 255.0;
}

/// Returns the difference of two values. Two NaNs or equal infinities differ by 0; any other value that is not finite
/// differs by infinity.
static double difference(double a, double b)
{
    if (a == b || (isnan(a) && isnan(b)))
        return 0;
    double d = fabs(a - b);
    return isfinite(d) ? d : INFINITY;
}

static void compare_pixels(const picture *a, const picture *b, const glint_compare_desc *desc, glint_compare_result *r)
{
    double sum = 0, squares = 0;
    size_t i = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            double worst = 0;
            for (int c = 0; c < a->channels; c++, i++) {
                double d = difference(value_at(a, i), value_at(b, i));
                sum += d;
                squares += d * d;
                worst = d > worst ? d : worst;
                if (d > r->max_error) {
                    r->max_error = d;
                    r->max_x = x;
                    r->max_y = y;
                    r->max_channel = c;
                }
            }
            r->failed += worst > desc->fail;
            r->warned += worst > desc->warn;
        }
    r->pixels = (uint64_t)a->width * (uint64_t)a->height;
    double count = (double)r->pixels * a->channels;
    r->mean_error = sum / count;
    r->rms_error = sqrt(squares / count);
    r->peak_snr = r->rms_error > 0 ? -20 * glint_log(r->rms_error) / glint_log(10) : INFINITY;
}

static glint_status compare(const char *a, const picture *pa, const char *b, const picture *pb,
                            const glint_compare_desc *desc, glint_compare_result *out, glint_error *error)
{
    if (pa->width != pb->width || pa->height != pb->height || pa->channels != pb->channels) {
        *out = (glint_compare_result) { .width = -1 };
        return glint_fail(error, GLINT_ERR_INVALID, "%.200s is %d x %d with %d channels, %.200s %d x %d with %d", a,
                          pa->width, pa->height, pa->channels, b, pb->width, pb->height, pb->channels);
    }
    *out = (glint_compare_result) { .width = pa->width, .height = pa->height, .channels = pa->channels };
    compare_pixels(pa, pb, desc, out);
    return GLINT_OK;
}

glint_status glint_compare_files(const char *a, const char *b, const glint_compare_desc *desc,
                                 glint_compare_result *out, glint_error *error)
{
    GLINT_REFUSE_NULL(a, error);
    GLINT_REFUSE_NULL(b, error);
    GLINT_REFUSE_NULL(out, error);
    glint_compare_desc thresholds = desc ? *desc : (glint_compare_desc) { 1e-6, 1e-6 };
    if (!(thresholds.fail >= 0) || !(thresholds.warn >= 0))
        return glint_fail(error, GLINT_ERR_INVALID, "fail, warn: numbers >= 0 expected, got %g, %g", thresholds.fail,
                          thresholds.warn);
    picture pa = { 0 }, pb = { 0 };
    glint_status status = load(a, &pa, error);
    if (!status)
        status = load(b, &pb, error);
    if (!status)
        status = compare(a, &pa, b, &pb, &thresholds, out, error);
    free_picture(&pa);
    free_picture(&pb);
    return status;
}
