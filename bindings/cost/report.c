// The report of glint cost: a page that needs no network, with its plot as a file beside it, and the pictures.
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/cost/cost.h"

#define PAGE_MAX 12000000 // bytes of pictures in the page

// bindings/cost/page.html, made into bytes by the Makefile.
static const char PAGE[] = {
#include "bindings/cost/page.html.h"
};

void cost_html_text(FILE *out, const char *text)
{
    for (const char *at = text; *at; at++) {
        switch (*at) {
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '&':
            fputs("&amp;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        case '\'':
            fputs("&#39;", out);
            break;
        default:
            fputc(*at, out);
        }
    }
}

// ---- The table ----

static double all_rays(const cost_case *c)
{
    const glint_ray_counts *rays = &c->stats.rays;
    return (double)rays->primary + (double)rays->shadow + (double)rays->mirror + (double)rays->refraction +
           (double)rays->indirect;
}

static void write_cell(FILE *out, double value, const char *format, double shown)
{
    if (isfinite(value)) {
        fprintf(out, "<td data-v='%.9g'>", value);
        fprintf(out, format, shown);
        fputs("</td>", out);
    } else {
        fputs("<td data-v=''>&ndash;</td>", out);
    }
}

static void write_errors(const cost_study *study, const cost_row *row, FILE *out)
{
    const glint_picture_error *error = cost_row_error(study, row);
    const cost_case *c = &study->cases[row->measured];
    const glint_picture_error none = { NAN, NAN, NAN, NAN, NAN, NAN };
    const glint_picture_error *e = error ? error : &none;
    write_cell(out, e->rmse, "%.2g", e->rmse);
    write_cell(out, e->relmse, "%.2g", e->relmse);
    write_cell(out, e->max_code, "%.3g", e->max_code);
    write_cell(out, e->over1, "%.2g %%", 100 * e->over1);
    write_cell(out, e->over8, "%.2g %%", 100 * e->over8);
    write_cell(out, e->flip, "%.2g", e->flip);
    const double object = error ? (double)c->wrong_object : NAN, shadow = error ? (double)c->wrong_shadow : NAN;
    write_cell(out, object, "%.0f", object);
    write_cell(out, shadow, "%.0f", shadow);
    write_cell(out, all_rays(c), "%.0f", all_rays(c));
    write_cell(out, c->is_counted ? (double)c->work.tests : NAN, "%.0f", (double)c->work.tests);
    write_cell(out, c->is_counted ? (double)c->work.light_samples : NAN, "%.0f", (double)c->work.light_samples);
    write_cell(out, c->is_counted ? (double)c->work.powers : NAN, "%.0f", (double)c->work.powers);
}

static void spell_remarks(const cost_study *study, const cost_row *row, char out[128])
{
    const cost_case *c = &study->cases[row->measured];
    snprintf(out, 128, "%s%s%s%s%s", row->is_front ? ", on the front" : "", row->is_default ? ", the script's own" : "",
             row->measured != 0 && !row->is_partial && row->difference == 0 ? ", no difference in time" : "",
             cost_row_error(study, row) && !row->is_resolved ? ", error not resolved" : "",
             row->is_partial || c->is_left_out ? ", partial" : "");
}

// What the page says when the row's point is reached.
static void write_text(const cost_study *study, const cost_row *row, const char *remarks, FILE *out)
{
    const cost_case *c = &study->cases[row->measured];
    const glint_picture_error *error = cost_row_error(study, row);
    char name[COST_LABEL_SIZE];
    cost_row_name(row, name);
    cost_html_text(out, row->measured == 0 ? "the script's own setting" : name);
    fprintf(out, ": %.4g ms (%.4g to %.4g), %.3g times the fastest", c->time[COST_TOTAL].median, c->time[COST_TOTAL].q1,
            c->time[COST_TOTAL].q3, row->x_fastest);
    if (error)
        fprintf(out, "; RMSE %.2g, FLIP %.2g, %.2g %% of the pixels off by more than a code", error->rmse, error->flip,
                100 * error->over1);
    cost_html_text(out, remarks);
}

static void write_row(const cost_study *study, const cost_row *row, FILE *out)
{
    const cost_quartiles *time = &study->cases[row->measured].time[COST_TOTAL];
    char name[COST_LABEL_SIZE], remarks[128];
    cost_row_name(row, name);
    spell_remarks(study, row, remarks);
    fprintf(out, "<tr id='row-%d' data-text='", (int)(row - study->rows));
    write_text(study, row, remarks, out);
    fprintf(out, "'><td data-v='%03d'><span class='%s'>", (int)(row - study->rows),
            row->is_default ? "own"
            : row->is_front ? "best"
                            : "");
    cost_html_text(out, name);
    fputs("</span></td>", out);
    write_cell(out, time->median, "%.4g", time->median);
    fprintf(out, "<td data-v='%.9g'>%.4g &ndash; %.4g</td>", time->q3 - time->q1, time->q1, time->q3);
    write_cell(out, row->x_fastest, "%.3g", row->x_fastest);
    write_errors(study, row, out);
    fputs("<td class='remark' data-v='", out);
    cost_html_text(out, remarks);
    fputs("'>", out);
    cost_html_text(out, *remarks ? remarks + 2 : "");
    fputs("</td></tr>\n", out);
}

static void write_rows(const cost_study *study, FILE *out)
{
    for (int i = 0; i < study->row_count; i++)
        if (study->cases[study->rows[i].measured].run_count > 0)
            write_row(study, &study->rows[i], out);
}

// ---- Pictures ----

// "samples_16" of the first row that shows the case; the base is "own".
static void name_pictures(const cost_study *study, int index, char title[COST_LABEL_SIZE], char file[COST_LABEL_SIZE])
{
    for (int i = study->row_count - 1; i >= 0; i--)
        if (study->rows[i].measured == index)
            cost_row_name(&study->rows[i], title);
    if (index == 0)
        snprintf(title, COST_LABEL_SIZE, "the script's own setting");
    snprintf(file, COST_LABEL_SIZE, "%s", index == 0 ? "own" : title);
    for (char *at = file; *at; at++)
        if (*at == ' ' || *at == '=')
            *at = '_';
}

// A picture that is worth showing: not the script's own once more (another encoder, say).
static bool has_picture(const cost_study *study, int index)
{
    const cost_case *c = &study->cases[index], *own = &study->cases[0];
    return c->picture && c->difference &&
           (index == 0 || c->picture_size != own->picture_size ||
            memcmp(c->picture, own->picture, c->picture_size) != 0);
}

// Whether the pictures are in the page itself; beside it where they would make it too heavy.
static bool is_light(const cost_study *study)
{
    size_t sum = 0;
    for (int i = 0; i < study->case_count; i++)
        if (has_picture(study, i))
            sum += study->cases[i].picture_size + study->cases[i].difference_size;
    return sum <= PAGE_MAX;
}

static void write_base64(const uint8_t *data, size_t size, FILE *out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const size_t left = size - i;
        const uint32_t three =
            (uint32_t)data[i] << 16 | (left > 1 ? (uint32_t)data[i + 1] << 8 : 0) | (left > 2 ? data[i + 2] : 0u);
        for (int k = 0; k < 4; k++)
            fputc(k > (int)left ? '=' : digits[three >> (18 - 6 * k) & 63], out);
    }
}

static void write_picture(const cost_study *study, const char *file, const char *what, const uint8_t *data, size_t size,
                          FILE *out)
{
    fprintf(out, "<img loading='lazy' width='%.0f' height='%.0f' alt='%s' src='", study->own->desc.width,
            study->own->desc.height, what);
    if (is_light(study)) {
        fputs("data:image/png;base64,", out);
        write_base64(data, size, out);
    } else {
        fprintf(out, "%s.png", file);
    }
    fputs("'>", out);
}

static void write_pictures(const cost_study *study, FILE *out)
{
    char title[COST_LABEL_SIZE], file[COST_LABEL_SIZE], other[COST_LABEL_SIZE + 8];
    if (!study->reference || !study->cases[0].picture)
        return;
    fputs("<h2>The pictures, and their errors times 16</h2>\n<div class='pictures'>\n", out);
    for (int i = 0; i < study->case_count; i++) {
        const cost_case *c = &study->cases[i];
        if (!has_picture(study, i))
            continue;
        name_pictures(study, i, title, file);
        snprintf(other, sizeof other, "%s_error", file);
        fputs("<figure><div class='pair'>", out);
        write_picture(study, file, "the picture", c->picture, c->picture_size, out);
        write_picture(study, other, "its error times 16", c->difference, c->difference_size, out);
        fputs("</div><figcaption class='small'>", out);
        cost_html_text(out, title);
        fputs("</figcaption></figure>\n", out);
    }
    fputs("</div>\n", out);
}

// ---- The words ----

static void write_lead(const cost_study *study, FILE *out)
{
    const glintL_run *run = study->run;
    char machine[256];
    cost_machine(study, machine);
    fprintf(out,
            "Frame %" PRId64
            ", %.0f &times; %.0f pixels, %.0f sample%s a pixel, each setting timed %d times in random order",
            run->explain_frame, study->own->desc.width, study->own->desc.height, study->own->desc.samples,
            study->own->desc.samples == 1 ? "" : "s", study->runs);
    fputs(study->is_complete ? " on " : " (interrupted: part of the study only) on ", out);
    cost_html_text(out, machine);
    fputc('.', out);
}

static void write_reference(const cost_study *study, FILE *out)
{
    if (!study->reference) {
        fputs("No reference was rendered, so no error is known.", out);
        return;
    }
    char truth[COST_LABEL_SIZE];
    cost_truth_name(study, truth);
    fprintf(
        out,
        "Errors are against the mean of two pictures of %.0f samples a pixel, decided in double, of seeds %.0f and "
        "%.0f%s. By their difference that mean is itself %.2g RMSE from the truth; an error under ten times that is "
        "marked as not resolved.",
        study->reference_samples, study->reference_seed[0], study->reference_seed[1], truth,
        study->reference_error.rmse);
}

static void write_left_out(const cost_study *study, FILE *out)
{
    if (study->left_out_count == 0)
        return;
    fputs("<h2>Left out</h2>\n<ul>\n", out);
    for (int i = 0; i < study->left_out_count; i++) {
        fputs("<li>", out);
        cost_html_text(out, study->left_out[i]);
        fputs("</li>\n", out);
    }
    fputs("</ul>\n", out);
}

static void write_script(const cost_study *study, FILE *out) { cost_html_text(out, study->run->script); }
static void write_advice(const cost_study *study, FILE *out) { cost_html_text(out, study->advice); }

// The page with what its @NAMES@ stand for.
static void write_page(const cost_study *study, FILE *out)
{
    static const struct {
        const char *name;
        void (*write)(const cost_study *study, FILE *out);
    } parts[] = { { "@SCRIPT@", write_script },     { "@LEAD@", write_lead },    { "@REFERENCE@", write_reference },
                  { "@PLOT@", cost_plot },          { "@ROWS@", write_rows },    { "@LEFT_OUT@", write_left_out },
                  { "@PICTURES@", write_pictures }, { "@ADVICE@", write_advice } };
    const char *end = PAGE + sizeof PAGE;
    for (const char *at = PAGE; at < end; at++) {
        size_t part = 0;
        while (part < sizeof parts / sizeof *parts && ((size_t)(end - at) < strlen(parts[part].name) ||
                                                       strncmp(at, parts[part].name, strlen(parts[part].name)) != 0))
            part++;
        if (part == sizeof parts / sizeof *parts) {
            fputc(*at, out);
            continue;
        }
        parts[part].write(study, out);
        at += strlen(parts[part].name) - 1;
    }
}

// ---- Files ----

static bool complain(const char *path, char message[GLINTL_MESSAGE_SIZE])
{
    snprintf(message, GLINTL_MESSAGE_SIZE, "%.800s: %s", path, strerror(errno));
    return false;
}

static bool make_folders(const char *folder)
{
    char path[GLINTL_PATH_SIZE];
    snprintf(path, sizeof path, "%s", folder);
    for (char *at = path + 1; *at; at++) {
        if (*at != '/')
            continue;
        *at = '\0';
        mkdir(path, 0777); // whether it is there now shows at the end
        *at = '/';
    }
    const int why = mkdir(path, 0777) == 0 ? 0 : errno;
    struct stat info;
    if (stat(path, &info) == 0) {
        errno = ENOTDIR;
        return S_ISDIR(info.st_mode);
    }
    errno = why;
    return false;
}

bool cost_report_check(const char *folder, char message[GLINTL_MESSAGE_SIZE])
{
    if (!*folder || strlen(folder) > GLINTL_PATH_SIZE - 2 * COST_LABEL_SIZE) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "a folder to write to expected, got '%.200s'", folder);
        return false;
    }
    errno = 0;
    if (make_folders(folder) && access(folder, W_OK | X_OK) == 0)
        return true;
    const int why = errno;
    snprintf(message, GLINTL_MESSAGE_SIZE, "a folder to write to expected, got '%.600s': %s", folder, strerror(why));
    return false;
}

// A file that appears whole or not at all.
static FILE *open_file(const char *folder, const char *name, char path[GLINTL_PATH_SIZE],
                       char message[GLINTL_MESSAGE_SIZE])
{
    snprintf(path, GLINTL_PATH_SIZE, "%s/.%s.%ld.tmp", folder, name, (long)getpid());
    FILE *file = fopen(path, "we");
    if (!file)
        complain(path, message);
    return file;
}

static bool close_file(FILE *file, const char *folder, const char *name, const char *path,
                       char message[GLINTL_MESSAGE_SIZE])
{
    char final[GLINTL_PATH_SIZE];
    errno = EIO;
    bool good = !ferror(file) && fflush(file) == 0 && fsync(fileno(file)) == 0;
    const int why = errno;
    snprintf(final, sizeof final, "%s/%s", folder, name);
    if (fclose(file) == 0 && good && rename(path, final) == 0)
        return true;
    errno = good ? errno : why;
    complain(final, message);
    unlink(path);
    return false;
}

static bool write_text_file(const cost_study *study, const char *folder, const char *name,
                            void (*write)(const cost_study *study, FILE *out), char message[GLINTL_MESSAGE_SIZE])
{
    char path[GLINTL_PATH_SIZE];
    FILE *file = open_file(folder, name, path, message);
    if (!file)
        return false;
    write(study, file);
    return close_file(file, folder, name, path, message);
}

static bool write_bytes(const char *folder, const char *name, const uint8_t *data, size_t size,
                        char message[GLINTL_MESSAGE_SIZE])
{
    char path[GLINTL_PATH_SIZE], file_name[COST_LABEL_SIZE + 16];
    snprintf(file_name, sizeof file_name, "%s.png", name);
    FILE *file = open_file(folder, file_name, path, message);
    if (!file)
        return false;
    fwrite(data, 1, size, file);
    return close_file(file, folder, file_name, path, message);
}

// Without an error there is nothing to draw; the plot of an earlier study in the folder would pass for this one's.
static bool write_plot(const cost_study *study, const char *folder, char message[GLINTL_MESSAGE_SIZE])
{
    char path[GLINTL_PATH_SIZE];
    if (cost_has_plot(study))
        return write_text_file(study, folder, "plot.svg", cost_plot, message);
    snprintf(path, sizeof path, "%s/plot.svg", folder);
    return unlink(path) == 0 || errno == ENOENT || complain(path, message);
}

bool cost_report_write(const cost_study *study, const char *folder, char message[GLINTL_MESSAGE_SIZE])
{
    char title[COST_LABEL_SIZE], file[COST_LABEL_SIZE], other[COST_LABEL_SIZE + 8];
    bool good = true;
    for (int i = 0; i < study->case_count && good && !is_light(study); i++) {
        const cost_case *c = &study->cases[i];
        if (!has_picture(study, i))
            continue;
        name_pictures(study, i, title, file);
        snprintf(other, sizeof other, "%s_error", file);
        good = write_bytes(folder, file, c->picture, c->picture_size, message) &&
               write_bytes(folder, other, c->difference, c->difference_size, message);
    }
    return good && write_plot(study, folder, message) &&
           write_text_file(study, folder, "index.html", write_page, message);
}
