// Frame selection: "1-3,5,7-20:2,90-" and shards "2/4".
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"

// Reads decimal digits. False: there are none, or too many.
static bool read_whole(const char **text, int64_t *out)
{
    char *end;
    if (**text < '0' || **text > '9')
        return false;
    errno = 0;
    long long value = strtoll(*text, &end, 10);
    if (errno || value == INT64_MAX) // INT64_MAX marks an open end
        return false;
    *out = value;
    *text = end;
    return true;
}

// Reads one part of the list: "5", "1-3", "7-20:2", "90-". False: it is invalid or empty.
static bool read_range(const char **text, glintL_range *range)
{
    range->step = 1;
    if (!read_whole(text, &range->first))
        return false;
    range->last = range->first;
    if (**text == '-') {
        ++*text;
        range->last = INT64_MAX;
        if (**text >= '0' && **text <= '9' && !read_whole(text, &range->last))
            return false;
    }
    if (**text == ':') {
        ++*text;
        if (range->last == range->first || !read_whole(text, &range->step))
            return false;
    }
    return range->step >= 1 && range->last >= range->first;
}

bool glintL_selection_add(glintL_selection *selection, glintL_range range)
{
    glintL_range *grown = realloc(selection->ranges, (selection->range_count + 1) * sizeof *grown);
    if (!grown)
        return false;
    grown[selection->range_count++] = range;
    selection->ranges = grown;
    return true;
}

void glintL_selection_clear(glintL_selection *selection)
{
    free(selection->ranges);
    selection->ranges = NULL;
    selection->range_count = 0;
}

bool glintL_selection_parse(glintL_selection *selection, const char *text, char message[GLINTL_MESSAGE_SIZE])
{
    glintL_selection read = { 0 };
    glintL_range range;
    const char *at = text;
    bool good, full = false;
    do {
        good = read_range(&at, &range);
        full = good && !glintL_selection_add(&read, range);
    } while (good && !full && *at == ',' && *++at);
    if (full) {
        glintL_selection_clear(&read);
        return glintL_complain(message, "out of memory");
    }
    if (!good || *at || at[-1] == ',') {
        glintL_selection_clear(&read);
        return glintL_complain(message, "frames such as 1-3,5,7-20:2,90- expected, got '%.200s'", text);
    }
    glintL_selection_clear(selection);
    selection->ranges = read.ranges;
    selection->range_count = read.range_count;
    return true;
}

bool glintL_selection_parse_shard(glintL_selection *selection, const char *text, char message[GLINTL_MESSAGE_SIZE])
{
    int64_t shard, count;
    const char *at = text;
    if (read_whole(&at, &shard) && *at == '/' && (++at, read_whole(&at, &count)) && *at == '\0' && shard >= 1 &&
        shard <= count && count <= 1000000) {
        selection->shard = shard;
        selection->shard_count = count;
        return true;
    }
    return glintL_complain(message, "K/N with 1 <= K <= N <= 1000000 expected, got '%.200s'", text);
}

bool glintL_selection_is_whole(const glintL_selection *selection)
{
    return selection->range_count == 0 && selection->shard_count == 0;
}

bool glintL_selection_has(const glintL_selection *selection, int64_t number)
{
    for (size_t i = 0; i < selection->range_count; i++) {
        const glintL_range *range = &selection->ranges[i];
        if (number >= range->first && number <= range->last && (number - range->first) % range->step == 0)
            return true;
    }
    return selection->range_count == 0;
}

int64_t glintL_selection_count(const glintL_selection *selection, int64_t first, int64_t last)
{
    int64_t count = 0;
    if (selection->range_count == 0)
        return last >= first ? last - first + 1 : 0;
    for (int64_t number = first; number <= last; number++)
        count += glintL_selection_has(selection, number);
    return count;
}

void glintL_selection_part(const glintL_selection *selection, int64_t first, int64_t last, int64_t *from, int64_t *to)
{
    int64_t count = glintL_selection_count(selection, first, last);
    *from = 1;
    *to = count;
    if (selection->shard_count > 0) {
        *from = (selection->shard - 1) * count / selection->shard_count + 1;
        *to = selection->shard * count / selection->shard_count;
    }
}

// Returns whether frames outside first .. last were selected by number; writes the warning.
static bool names_others(const glintL_selection *selection, int64_t first, int64_t last, char message[GLINTL_MESSAGE_SIZE])
{
    for (size_t i = 0; i < selection->range_count; i++) {
        const glintL_range *range = &selection->ranges[i];
        bool open = range->last == INT64_MAX;
        if (range->first >= first && range->first <= last && (open || range->last <= last))
            continue;
        char named[64] = "";
        if (!open && range->last != range->first)
            snprintf(named, sizeof named, "%" PRId64, range->last);
        bool one = range->first == range->last;
        snprintf(message, GLINTL_MESSAGE_SIZE,
                 "%s%" PRId64 "%s%s%s left out: the frames of the script are %" PRId64 " .. %" PRId64,
                 one ? "frame " : "some of the frames ", range->first, one ? "" : "-", named, one ? " is" : " are", first, last);
        return true;
    }
    return false;
}

// Returns whether a range contains one of the frames first .. last.
static bool has_any(const glintL_range *range, int64_t first, int64_t last)
{
    int64_t before = range->first < first ? first - range->first : 0; // rounded up to whole steps
    int64_t nearest = range->first + (before + range->step - 1) / range->step * range->step;
    return nearest <= (range->last < last ? range->last : last);
}

bool glintL_selection_settle(glintL_run *run, int64_t first, int64_t last)
{
    char message[GLINTL_MESSAGE_SIZE];
    const glintL_selection *selection = &run->request.selection;
    bool any = selection->range_count == 0;
    for (size_t i = 0; i < selection->range_count && !any; i++)
        any = has_any(&selection->ranges[i], first, last);
    if (!any)
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0,
                               "frames: no frame is selected: the frames of the script are %" PRId64 " .. %" PRId64,
                               first, last);
    if (names_others(selection, first, last, message))
        glintL_run_warn(run, "%s", message);
    return run->exit_code == 0;
}
