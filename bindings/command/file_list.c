// The files that a command's words name: the words themselves, or all files that match a pattern such as
// "frame_%04d.png".
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "bindings/command/cli.h"

// Finds the numbers of the files that match the pattern, which has one number in the last part of the path.
static bool find_numbers(const char *pattern, int64_t **numbers, size_t *count, char *message)
{
    char folder[GLINTL_PATH_SIZE], made[GLINTL_PATH_SIZE];
    const glintL_naming naming = { .pattern = pattern };
    const char *slash = strrchr(pattern, '/'), *name = slash ? slash + 1 : pattern;
    size_t before = strcspn(name, "%#"), capacity = 0;
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - pattern) + 1 : 1, slash ? pattern : ".");
    DIR *directory = opendir(folder);
    if (!directory)
        return glintL_complain(message, "%.200s: %s", folder, strerror(errno));
    bool good = true;
    for (struct dirent *entry; good && (entry = readdir(directory));) {
        if (strlen(entry->d_name) <= before || entry->d_name[before] < '0' || entry->d_name[before] > '9')
            continue;
        int64_t number = strtoll(entry->d_name + before, NULL, 10);
        if (number < 0 || number > GLINTL_FRAMES_MAX || !glintL_name_file(&naming, number, "beauty", made) ||
            strcmp(made + (name - pattern), entry->d_name) != 0)
            continue;
        if (*count == capacity) {
            int64_t *grown = realloc(*numbers, (capacity = capacity ? 2 * capacity : 256) * sizeof *grown);
            good = grown != NULL;
            *numbers = grown ? grown : *numbers;
        }
        if (good)
            (*numbers)[(*count)++] = number;
    }
    closedir(directory);
    if (!good)
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
    return good;
}

static int by_size(const void *a, const void *b)
{
    int64_t left = *(const int64_t *)a, right = *(const int64_t *)b;
    return (left > right) - (left < right);
}

static bool has_number(const int64_t *numbers, size_t count, int64_t number)
{
    return bsearch(&number, numbers, count, sizeof number, by_size) != NULL;
}

// Adds "3, 5-7" to the message.
static void add_range(char *message, int64_t first, int64_t last, bool *any)
{
    size_t used = strlen(message);
    if (used > GLINTL_MESSAGE_SIZE - 120)
        return;
    snprintf(message + used, GLINTL_MESSAGE_SIZE - used, first == last ? "%s%" PRId64 : "%s%" PRId64 "-%" PRId64,
             *any ? ", " : " ", first, last);
    *any = true;
}

// Returns whether every wanted number from `first` to `last` exists. The message names the missing ones.
static bool check_gaps(const char *pattern, const int64_t *numbers, size_t count, const glintL_selection *selection,
                       int64_t first, int64_t last, char *message)
{
    int64_t from = 0, to = 0;
    bool any = false;
    snprintf(message, GLINTL_MESSAGE_SIZE, "%.200s: these frames are missing:", pattern);
    for (int64_t n = first; n <= last; n++) {
        if (!glintL_selection_has(selection, n) || has_number(numbers, count, n))
            continue;
        if (from && to == n - 1) {
            to = n;
            continue;
        }
        if (from)
            add_range(message, from, to, &any);
        from = to = n;
    }
    if (from)
        add_range(message, from, to, &any);
    return !any;
}

// Returns the last number that a selection names; 0: the selection is open-ended or empty.
static int64_t last_request(const glintL_selection *selection)
{
    int64_t last = 0;
    for (size_t i = 0; i < selection->range_count; i++) {
        if (selection->ranges[i].last == INT64_MAX)
            return 0;
        last = selection->ranges[i].last > last ? selection->ranges[i].last : last;
    }
    return last;
}

// Returns the number at the end of a file's name, before its extension; -1: none.
static int64_t number_of(const char *path)
{
    const char *name = glintL_base_name(path), *ending = strrchr(name, '.');
    const char *end = ending ? ending : name + strlen(name), *at = end;
    while (at > name && at[-1] >= '0' && at[-1] <= '9')
        at--;
    const int64_t number = at < end ? strtoll(at, NULL, 10) : -1;
    return number <= GLINTL_FRAMES_MAX ? number : -1;
}

static bool add_file(cli_file_list *out, const char *path, int64_t number, char *message)
{
    char **grown = realloc(out->files, (out->count + 1) * sizeof *grown);
    if (grown)
        out->files = grown;
    int64_t *numbers = realloc(out->numbers, (out->count + 1) * sizeof *numbers);
    if (numbers)
        out->numbers = numbers;
    char *copy = grown && numbers ? strdup(path) : NULL;
    if (!copy)
        return glintL_complain(message, "out of memory");
    out->numbers[out->count] = number;
    out->files[out->count++] = copy;
    return true;
}

// Returns whether a word contains shell wildcards that no shell has expanded.
static bool is_quoted_wildcard(const char *word, char *message)
{
    struct stat info;
    if (!word[strcspn(word, "*?")] || stat(word, &info) == 0)
        return false;
    snprintf(message, GLINTL_MESSAGE_SIZE,
             "%.200s: no such file; give the names without quotes, or a pattern such as 'frame_%%04d.png'", word);
    return true;
}

// Returns whether a figure would overwrite a file that it is made of.
static bool is_among(const cli_file_list *list, const char *output, char *message)
{
    struct stat out, file;
    if (!output || stat(output, &out) != 0 || !S_ISREG(out.st_mode))
        return false;
    for (size_t i = 0; i < list->count; i++)
        if (stat(list->files[i], &file) == 0 && file.st_dev == out.st_dev && file.st_ino == out.st_ino) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "-o: '%.200s' is one of the input pictures; give another file",
                     output);
            return true;
        }
    return false;
}

static bool add_words(const cli_options *options, cli_file_list *out, char *message)
{
    for (int i = 0; i < options->argument_count; i++)
        if (is_quoted_wildcard(options->arguments[i], message) ||
            !add_file(out, options->arguments[i], number_of(options->arguments[i]), message))
            return false;
    if (out->count == 0)
        snprintf(message, GLINTL_MESSAGE_SIZE, "expected finished pictures, or a pattern such as 'frame_%%04d.png'");
    return out->count > 0;
}

static bool add_numbers(const char *pattern, const int64_t *numbers, size_t count, const glintL_selection *selection,
                        cli_file_list *out, char *message)
{
    char path[GLINTL_PATH_SIZE];
    const glintL_naming naming = { .pattern = pattern };
    bool good = true;
    for (size_t i = 0; i < count && good; i++)
        if (glintL_selection_has(selection, numbers[i])) {
            good = glintL_name_file(&naming, numbers[i], "beauty", path);
            good = good && add_file(out, path, numbers[i], message);
        }
    if (good && out->count == 0)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%.200s: there is no such frame", pattern);
    return good && out->count > 0;
}

static bool add_pattern(const char *pattern, const glintL_selection *selection, cli_file_list *out, char *message)
{
    int64_t *numbers = NULL;
    size_t count = 0;
    bool good = find_numbers(pattern, &numbers, &count, message);
    if (good && count > 0)
        qsort(numbers, count, sizeof *numbers, by_size);
    if (good && count > 0) {
        int64_t request = last_request(selection), last = numbers[count - 1];
        int64_t first = selection->range_count ? selection->ranges[0].first : numbers[0];
        for (size_t i = 1; i < selection->range_count; i++)
            first = selection->ranges[i].first < first ? selection->ranges[i].first : first;
        good = check_gaps(pattern, numbers, count, selection, first, request ? request : last, message);
    }
    good = good && add_numbers(pattern, numbers, count, selection, out, message);
    free(numbers);
    return good;
}

bool cli_list_files(const cli_options *options, const glintL_selection *selection, cli_file_list *out,
                    char message[GLINTL_MESSAGE_SIZE])
{
    bool good = false;
    *out = (cli_file_list) { 0 };
    if (options->argument_count == 1 && glintL_name_check(options->arguments[0], message) &&
        !glintL_name_is_special(options->arguments[0]) && glintL_name_has_number(options->arguments[0]))
        good = add_pattern(options->arguments[0], selection, out, message);
    else if (selection->range_count)
        snprintf(message, GLINTL_MESSAGE_SIZE, "--frames: expected together with a pattern such as 'frame_%%04d.png'");
    else
        good = add_words(options, out, message);
    return good && !is_among(out, options->output, message);
}

void cli_free_list(cli_file_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->files[i]);
    free(list->files);
    free(list->numbers);
}
