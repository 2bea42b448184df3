// The plot of glint cost: time against error, both logarithmic, as SVG that follows the reader's light or dark.
#include <math.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define WIDTH 540
#define HEIGHT 420
#define LEFT 62
#define RIGHT 16
#define TOP 16
#define BOTTOM 50
#define CHARACTER 6.6 // width of one, on average
#define LABELS_MAX 64

typedef struct range {
    double low, high; // logarithms
} range;

typedef struct box {
    double x, y, width, height;
} box;

typedef struct plot {
    const cost_study *study;
    FILE *out;
    range time, error;
    box taken[LABELS_MAX]; // by labels and points
    int taken_count;
} plot;

static double x_of(const plot *p, double ms)
{
    return LEFT + (log10(ms) - p->time.low) / (p->time.high - p->time.low) * (WIDTH - LEFT - RIGHT);
}

static double y_of(const plot *p, double error)
{
    return HEIGHT - BOTTOM - (log10(error) - p->error.low) / (p->error.high - p->error.low) * (HEIGHT - TOP - BOTTOM);
}

// Whether the row is a point of its own: the script's setting is drawn once.
static bool is_drawn(const cost_study *study, const cost_row *row)
{
    const cost_knob *knob = cost_row_knob(row);
    const glint_picture_error *error = cost_row_error(study, row);
    const cost_case *c = &study->cases[row->measured];
    if (!error || !(error->rmse > 0) || !(c->time[COST_TOTAL].median > 0) || (knob && knob->is_other_time))
        return false;
    for (const cost_row *before = study->rows; before < row && row->measured == 0; before++)
        if (before->measured == 0 && is_drawn(study, before))
            return false;
    return true;
}

static void widen(range *r, double value)
{
    double at = log10(value);
    r->low = fmin(r->low, at);
    r->high = fmax(r->high, at);
}

static bool find_ranges(plot *p)
{
    const cost_study *study = p->study;
    int count = 0;
    p->time = p->error = (range) { INFINITY, -INFINITY };
    for (int i = 0; i < study->row_count; i++) {
        const cost_row *row = &study->rows[i];
        if (!is_drawn(study, row))
            continue;
        count++;
        widen(&p->time, study->cases[row->measured].time[COST_TOTAL].median);
        widen(&p->error, cost_row_error(study, row)->rmse);
    }
    range *const ranges[] = { &p->time, &p->error };
    for (int i = 0; i < 2; i++) { // room around the points
        double more = 0.08 * (ranges[i]->high - ranges[i]->low) + 0.05;
        ranges[i]->low -= more;
        ranges[i]->high += more;
    }
    return count > 0;
}

// ---- What is taken ----

static bool is_free(const plot *p, const box *b)
{
    if (b->x < LEFT || b->x + b->width > WIDTH || b->y < 2 || b->y + b->height > HEIGHT - BOTTOM)
        return false;
    for (int i = 0; i < p->taken_count; i++) {
        const box *t = &p->taken[i];
        if (b->x < t->x + t->width && t->x < b->x + b->width && b->y < t->y + t->height && t->y < b->y + b->height)
            return false;
    }
    return true;
}

static void take(plot *p, box b)
{
    if (p->taken_count < LABELS_MAX)
        p->taken[p->taken_count++] = b;
}

// ---- Axes ----

static void draw_tick(plot *p, bool is_time, double value)
{
    double at = is_time ? x_of(p, value) : y_of(p, value);
    if (is_time)
        fprintf(
            p->out,
            "<path class='grid' d='M%.1f %dV%d'/><text class='tick' x='%.1f' y='%d' text-anchor='middle'>%g</text>\n",
            at, TOP, HEIGHT - BOTTOM, at, HEIGHT - BOTTOM + 17, value);
    else
        fprintf(p->out,
                "<path class='grid' d='M%d %.1fH%d'/><text class='tick' x='%d' y='%.1f' text-anchor='end'>%g</text>\n",
                LEFT, at, WIDTH - RIGHT, LEFT - 7, at + 4, value);
}

static void draw_axis(plot *p, bool is_time)
{
    static const double steps[] = { 1, 2, 5 };
    const range *r = is_time ? &p->time : &p->error;
    const int each = r->high - r->low < 3 ? 1 : 3; // 1, 2, 5 or decades alone
    for (int decade = (int)floor(r->low); decade <= (int)r->high; decade++)
        for (int i = 0; i < 3; i += each) {
            double value = steps[i] * pow(10, decade), at = log10(value);
            if (at >= r->low && at <= r->high)
                draw_tick(p, is_time, value);
        }
}

static void draw_frame(plot *p)
{
    draw_axis(p, true);
    draw_axis(p, false);
    fprintf(p->out, "<text class='name' x='%d' y='%d' text-anchor='middle'>milliseconds a frame</text>\n",
            (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12);
    fprintf(p->out,
            "<text class='name' transform='translate(15 %d) rotate(-90)' text-anchor='middle'>error: RMSE of linear "
            "light</text>\n",
            (TOP + HEIGHT - BOTTOM) / 2);
    double floor_error = 10 * p->study->reference_error.rmse;
    if (floor_error > 0 && log10(floor_error) > p->error.low && log10(floor_error) < p->error.high) {
        take(p, (box) { LEFT + 6, y_of(p, floor_error), 230, 17 });
        fprintf(p->out,
                "<path class='floor' d='M%d %.1fH%d'/><text class='tick' x='%d' y='%.1f'>below: not resolved by the "
                "reference</text>\n",
                LEFT, y_of(p, floor_error), WIDTH - RIGHT, LEFT + 6, y_of(p, floor_error) + 14);
    }
}

// ---- The front ----

static const cost_row *next_on_front(const cost_study *study, double after_ms)
{
    const cost_row *next = NULL;
    for (int i = 0; i < study->row_count; i++) {
        const cost_row *row = &study->rows[i];
        double ms = study->cases[row->measured].time[COST_TOTAL].median;
        if (row->is_front && is_drawn(study, row) && ms > after_ms &&
            (!next || ms < study->cases[next->measured].time[COST_TOTAL].median))
            next = row;
    }
    return next;
}

// Steps: the error that can be had for the time.
static void draw_front(plot *p)
{
    const cost_study *study = p->study;
    const char *command = "M";
    double ms = 0, y = 0;
    fputs("<path class='front' d='", p->out);
    for (const cost_row *row = next_on_front(study, 0); row; row = next_on_front(study, ms)) {
        ms = study->cases[row->measured].time[COST_TOTAL].median;
        double x = x_of(p, ms);
        if (*command == 'L')
            fprintf(p->out, "L%.1f %.1f", x, y);
        y = y_of(p, cost_row_error(study, row)->rmse);
        fprintf(p->out, "%s%.1f %.1f", command, x, y);
        command = "L";
    }
    fputs("'/>\n", p->out);
}

// ---- Points and their labels ----

// Beside, above or below its point, where there is room; nowhere else.
static void draw_label(plot *p, const cost_row *row, const char *text)
{
    const double width = CHARACTER * (double)strlen(text);
    const double x = x_of(p, p->study->cases[row->measured].time[COST_TOTAL].median);
    const double y = y_of(p, cost_row_error(p->study, row)->rmse);
    const bool ends[] = { false, false, true, true, false, false }; // the text ends where its place does
    const box places[] = { { x + 9, y - 14, width, 13 },        { x + 9, y + 1, width, 13 },
                           { x - 9 - width, y + 1, width, 13 }, { x - 9 - width, y - 14, width, 13 },
                           { x - width / 2, y + 8, width, 13 }, { x - width / 2, y - 22, width, 13 } };
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        if (!is_free(p, &places[i]))
            continue;
        fprintf(p->out, "<text class='label' x='%.1f' y='%.1f'%s>", ends[i] ? places[i].x + width : places[i].x,
                places[i].y + 11, ends[i] ? " text-anchor='end'" : "");
        cost_html_text(p->out, text);
        fputs("</text>\n", p->out);
        take(p, places[i]);
        return;
    }
}

static void draw_point(plot *p, const cost_row *row)
{
    const cost_study *study = p->study;
    const cost_quartiles *time = &study->cases[row->measured].time[COST_TOTAL];
    const double error = cost_row_error(study, row)->rmse, x = x_of(p, time->median), y = y_of(p, error);
    const bool is_own = row->measured == 0;
    char name[COST_LABEL_SIZE];
    cost_row_name(row, name);
    fprintf(p->out, "<g class='point%s%s' tabindex='0' role='img' data-row='%d' aria-label='",
            row->is_front ? " best" : "", is_own ? " own" : "", (int)(row - study->rows));
    cost_html_text(p->out, is_own ? "the script's own setting" : name);
    fprintf(p->out, ": %.4g ms, error %.2g%s'>", time->median, error, row->is_front ? ", on the front" : "");
    fprintf(p->out, "<circle class='reach' cx='%.1f' cy='%.1f' r='14'/>", x, y);
    fprintf(p->out, "<path class='spread' d='M%.1f %.1fH%.1f'/>", x_of(p, fmax(time->q1, 1e-6)), y,
            x_of(p, fmax(time->q3, 1e-6)));
    if (is_own)
        fprintf(p->out, "<path class='mark' d='M%.1f %.1fl8 8l-8 8l-8 -8z'/>", x, y - 8);
    else
        fprintf(p->out, "<circle class='mark' cx='%.1f' cy='%.1f' r='5'/>", x, y);
    fputs("</g>\n", p->out);
    take(p, (box) { x - 7, y - 7, 14, 14 });
}

static void draw_points(plot *p)
{
    const cost_study *study = p->study;
    char name[COST_LABEL_SIZE];
    for (int own = 0; own < 2; own++) // the script's own on top of the others
        for (int i = 0; i < study->row_count; i++)
            if (is_drawn(study, &study->rows[i]) && (study->rows[i].measured == 0) == own)
                draw_point(p, &study->rows[i]);
    for (int rank = 0; rank < 3; rank++) // the more telling labels first
        for (int i = 0; i < study->row_count; i++) {
            const cost_row *row = &study->rows[i];
            const bool is_own = row->measured == 0;
            if (!is_drawn(study, row) || rank != (is_own ? 0 : row->is_front ? 1 : 2))
                continue;
            cost_row_name(row, name);
            draw_label(p, row, is_own ? "the script's own" : name);
        }
}

// ---- The picture ----

static const char STYLE[] =
    "<style>\n"
    ".glint-plot{--paper:#fff;--ink:#1c2430;--faint:#5d6877;--line:#dfe4ea;--best:#0b62c4;--own:#c2410c;"
    "font:12px system-ui,sans-serif;color:var(--ink)}\n"
    "@media (prefers-color-scheme:dark){.glint-plot{--paper:#151a21;--ink:#e6eaf0;--faint:#9aa6b4;--line:#2c3540;"
    "--best:#6cb0ff;--own:#ff9a5c}}\n"
    ".glint-plot .paper{fill:var(--paper)}.glint-plot text{fill:var(--ink)}.glint-plot .tick{fill:var(--faint)}\n"
    ".glint-plot .name{fill:var(--faint)}.glint-plot "
    ".label{font-size:11.5px;paint-order:stroke;stroke:var(--paper);stroke-width:3px}\n"
    ".glint-plot .grid{stroke:var(--line);fill:none}.glint-plot .floor{stroke:var(--faint);stroke-dasharray:2 4}\n"
    ".glint-plot .front{fill:none;stroke:var(--best);stroke-width:1.5;stroke-opacity:.6}\n"
    ".glint-plot .reach{fill:transparent}.glint-plot .spread{stroke:var(--faint);stroke-width:2}\n"
    ".glint-plot .mark{fill:var(--paper);stroke:var(--faint);stroke-width:1.5}\n"
    ".glint-plot .best .mark{fill:var(--best);stroke:var(--best)}\n"
    ".glint-plot .own .mark{fill:var(--own);stroke:var(--own)}\n"
    ".glint-plot .point{outline:none;cursor:pointer}\n"
    ".glint-plot .point:focus .reach,.glint-plot .point:hover .reach,.glint-plot .point.lit .reach"
    "{stroke:var(--ink);stroke-width:2}\n"
    "</style>\n";

bool cost_has_plot(const cost_study *study)
{
    plot p = { .study = study };
    return find_ranges(&p);
}

void cost_plot(const cost_study *study, FILE *out)
{
    plot p = { .study = study, .out = out };
    if (!find_ranges(&p))
        return;
    fprintf(out,
            "<svg xmlns='http://www.w3.org/2000/svg' class='glint-plot' viewBox='0 0 %d %d' role='group' "
            "aria-label='Time against error of each setting'>\n",
            WIDTH, HEIGHT);
    fputs(STYLE, out);
    fprintf(out, "<rect class='paper' width='%d' height='%d' rx='6'/>\n", WIDTH, HEIGHT);
    draw_frame(&p);
    draw_front(&p);
    draw_points(&p);
    fputs("</svg>\n", out);
}
