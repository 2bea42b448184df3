// glint reproduce FILE SCRIPT: renders the frame of a finished file again, with the options stored in the file, and
// compares the two.
#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/command/cli.h"

typedef enum verdict { // exit codes, in addition to the usual ones
    SAME = 0, // every byte is equal
    SAME_PIXELS = 3, // only the bytes differ
    DIFFERENT = 4, // the pixels differ
    UNREADABLE = 5 // no whole picture with a key
} verdict;

typedef struct reproduction {
    const char *file;
    glint_picture *picture;
    char *params, *options, *pass, *sweep; // split in place: the sets and render texts point into them
    char folder[256]; // temporary folder of the new file
    char output[300]; // the new file's name pattern
    char *made[GLINTL_PASSES_MAX + 1]; // owned names of the new files by pass; for light passes only the last one
    const char *made_path; // the file to compare
    bool lacks_memory; // a name in `made` could not be allocated
    char reason[GLINTL_MESSAGE_SIZE];
} reproduction;

// ---- Requesting the frame ----

static const char *text_of(const reproduction *r, const char *keyword)
{
    const char *text = glint_picture_text(r->picture, keyword);
    return text ? text : "";
}

// Splits lines of "name=value" and calls `take` for each. False: `take` failed.
static bool cut_lines(char *lines, bool (*take)(void *user, char *name, char *value), void *user)
{
    for (char *line = lines; line && *line;) {
        char *end = line + strcspn(line, "\n"), *equals = line + strcspn(line, "=\n");
        char *next = *end ? end + 1 : end;
        *end = '\0';
        if (*equals == '=') {
            *equals = '\0';
            if (!take(user, line, equals + 1))
                return false;
        }
        line = next;
    }
    return true;
}

// Adds a parameter. Its line breaks are stored as a backslash and an n.
static bool take_param(void *user, char *name, char *value)
{
    char *out = value;
    for (const char *at = value; *at; at++) {
        bool is_break = at[0] == '\\' && at[1] == 'n';
        *out++ = is_break ? '\n' : *at;
        at += is_break;
    }
    *out = '\0';
    return cli_add_set(user, name, value);
}

// Marks a parameter that --sweep had set as swept, because files store this. Swept sets come last, in their order.
static bool take_swept(void *user, char *name, char *value)
{
    glintL_request *request = user;
    size_t last = request->set_count - 1, at = 0;
    while (at < request->set_count && strcmp(request->sets[at].name, name) != 0)
        at++;
    if (at == request->set_count) // an axis of the script itself
        return true;
    memmove(request->sets + at, request->sets + at + 1, (last - at) * sizeof *request->sets);
    request->sets[last] = (glintL_set) { .name = name, .text = value };
    request->swept_count++;
    return true;
}

static bool take_option(void *user, char *name, char *value)
{
    glintL_request *request = user;
    int field = glintL_render_find(name);
    if (field >= 0)
        request->render_text[field] = value;
    return true;
}

static bool check_options(const glintL_request *request, char *message)
{
    glintL_render scratch = glintL_render_default();
    for (int field = 0; field < GLINTL_RENDER_FIELDS; field++)
        if (request->render_text[field] &&
            !glintL_render_set_text(&scratch, field, request->render_text[field], message))
            return false;
    return true;
}

static const char *host_name(void)
{
    static char host[32];
    if (gethostname(host, sizeof host) != 0)
        host[0] = '\0';
    host[sizeof host - 1] = '\0';
    for (char *c = host; *c; c++)
        *c = *c == '/' ? '-' : *c;
    return host;
}

static void remove_folder(const char *path)
{
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        unlinkat(dirfd(folder), entry->d_name, 0); // does not remove folders, such as "."
    if (folder)
        closedir(folder);
    rmdir(path);
}

// Removes the folders that killed processes on this host left.
static void collect_folders(const char *temporary)
{
    char prefix[48], path[512];
    DIR *folder = opendir(temporary);
    const int length = snprintf(prefix, sizeof prefix, "glint.%s.", host_name());
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        struct stat info;
        char *end = NULL;
        if (strncmp(entry->d_name, prefix, (size_t)length) != 0)
            continue;
        const long process = strtol(entry->d_name + length, &end, 10);
        if (process <= 0 || *end != '.' || kill((pid_t)process, 0) == 0 || errno != ESRCH)
            continue;
        snprintf(path, sizeof path, "%.200s/%.300s", temporary, entry->d_name);
        if (lstat(path, &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == geteuid())
            remove_folder(path);
    }
    if (folder)
        closedir(folder);
}

// Fills the request of the run. Returns 0 or an exit code, with the message.
static int make_request(reproduction *r, glintL_run *run, char *message)
{
    const char *frame = text_of(r, "glint:frame"), *temporary = getenv("TMPDIR");
    glintL_request *request = &run->request;
    if (!*text_of(r, "glint:key") || !*frame) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "%.300s: has no key and frame number, so glint cannot render it again", r->file);
        return UNREADABLE;
    }
    r->params = strdup(text_of(r, "glint:params"));
    r->options = strdup(text_of(r, "glint:options"));
    r->pass = strdup(text_of(r, "glint:pass"));
    r->sweep = strdup(text_of(r, "glint:sweep"));
    if (!r->params || !r->options || !r->pass || !r->sweep || !cut_lines(r->params, take_param, request)) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
        return GLINTL_EXIT_FAILED;
    }
    cut_lines(r->sweep, take_swept, request);
    cut_lines(r->options, take_option, request);
    if (!glintL_selection_parse(&request->selection, frame, message) || !check_options(request, message))
        return UNREADABLE;
    temporary = temporary && *temporary ? temporary : "/tmp";
    collect_folders(temporary);
    snprintf(r->folder, sizeof r->folder, "%.180s/glint.%s.%ld.XXXXXX", temporary, host_name(), (long)getpid());
    if (!mkdtemp(r->folder)) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "%.200s: cannot create this folder", r->folder);
        r->folder[0] = '\0';
        return GLINTL_EXIT_FAILED;
    }
    snprintf(r->output, sizeof r->output, "%s/%%04d.png", r->folder);
    request->render_text[glintL_render_find("output")] = r->output;
    request->render_text[glintL_render_find("passes")] = *r->pass ? r->pass : "none";
    request->force = true;
    return 0;
}

static void take_frame(void *context, const glintL_run *run, const glintL_record *record)
{
    reproduction *r = context;
    (void)run;
    for (int pass = 0; pass <= GLINTL_PASSES_MAX && pass < record->slots; pass++) {
        free(r->made[pass]);
        r->made[pass] = record->files[pass] ? strdup(record->files[pass]) : NULL;
        r->lacks_memory = r->lacks_memory || (record->files[pass] && !r->made[pass]);
    }
}

// Renders the frame. Returns 0 or an exit code, with the message.
static int render(reproduction *r, cli_options *options, glintL_run *run, char *message)
{
    cli_script script;
    run->no_sheets = true;
    run->reporter.context = r;
    run->reporter.rendering = NULL;
    run->reporter.frame = take_frame;
    run->reporter.warn = NULL;
    bool good = cli_run_script(&script, options, run) && glintL_call_settle(run);
    cli_close_script(&script);
    good = glintL_run_collect(run, true) && good;
    for (size_t i = 0; i < run->request.set_count; i++)
        if (!good && !run->request.sets[i].is_known && strstr(run->message, "--set ")) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "%.200s: has no parameter '%.100s', but %.200s was rendered with it",
                     run->script, run->request.sets[i].name, r->file);
            return GLINTL_EXIT_USAGE;
        }
    if (run->exit_code || run->interrupted) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", run->interrupted ? "interrupted" : run->message);
        return run->exit_code ? run->exit_code : GLINTL_EXIT_FAILED;
    }
    glint_pass pass = *r->pass ? glint_pass_from_name(r->pass) : GLINT_PASS_BEAUTY;
    if (strncmp(r->pass, "d:", 2) == 0)
        pass = GLINT_PASS_DERIVATIVE; // the only derivative
    if (strncmp(r->pass, "light:", 6) == 0)
        pass = GLINT_PASS_LIGHT; // the only light pass
    r->made_path = pass <= GLINTL_PASSES_MAX ? r->made[pass] : NULL;
    if (r->made_path)
        return 0;
    if (r->lacks_memory) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
        return GLINTL_EXIT_FAILED;
    }
    snprintf(message, GLINTL_MESSAGE_SIZE, "%.200s: has no frame %s", run->script, text_of(r, "glint:frame"));
    return GLINTL_EXIT_USAGE;
}

// ---- Comparing ----

// Compares the bytes of two files. False: one cannot be read, and the message says why.
static bool compare_bytes(const char *a, const char *b, bool *equal, char *message)
{
    FILE *one = fopen(a, "rb"), *other = one ? fopen(b, "rb") : NULL;
    bool same = one && other;
    int c = 0;
    if (!same)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%.300s: %s", one ? b : a, strerror(errno));
    while (same && c != EOF) {
        c = getc(one);
        same = getc(other) == c;
    }
    *equal = same && !ferror(one) && !ferror(other);
    same = one && other;
    if (one)
        fclose(one);
    if (other)
        fclose(other);
    return same;
}

// Returns whether the texts differ; then writes the reason.
static bool is_reason(reproduction *r, const glint_picture *made, const char *keyword, const char *name)
{
    const char *had = text_of(r, keyword), *has = glint_picture_text(made, keyword);
    if (!has || strcmp(had, has) == 0)
        return false;
    snprintf(r->reason, sizeof r->reason, "another %s: '%.100s' then, '%.100s' now", name, *had ? had : "not noted",
             has);
    return true;
}

// Finds why the files differ, as far as their texts show.
static void find_reason(reproduction *r, const glint_picture *made)
{
    const char *source = glint_picture_text(made, "glint:source"), *key = glint_picture_text(made, "glint:key");
    bool same_source = source && strcmp(source, text_of(r, "glint:source")) == 0;
    bool same_key = key && strcmp(key, text_of(r, "glint:key")) == 0;
    if (is_reason(r, made, "Software", "engine version") || is_reason(r, made, "glint:script", "script") ||
        is_reason(r, made, "glint:encoder", "encoder"))
        return;
    if (same_key)
        snprintf(r->reason, sizeof r->reason, "%s",
                 same_source
                     ? "the frame has the same key: the file was changed, or compressed on another kind of processor"
                     : "another script: its text has changed, but not the parts that this frame depends on");
    else
        snprintf(r->reason, sizeof r->reason, "%s",
                 same_source ? "the script or a file that it reads has changed, and now describes another frame"
                             : "another script: its text has changed");
}

static verdict compare(reproduction *r, glint_compare_result *result, char *message)
{
    glint_compare_desc desc = { .fail = 0, .warn = 0 };
    glint_picture *made = NULL;
    glint_error error;
    bool equal;
    if (!compare_bytes(r->file, r->made_path, &equal, message))
        return UNREADABLE;
    if (equal)
        return SAME;
    if (glint_picture_read(r->made_path, false, &made, &error) ||
        glint_compare_files(r->file, r->made_path, &desc, result, &error)) {
        snprintf(r->reason, sizeof r->reason, "%s", error.message);
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
        glint_picture_destroy(made);
        return DIFFERENT;
    }
    find_reason(r, made);
    glint_picture_destroy(made);
    return result->max_error > 0 ? DIFFERENT : SAME_PIXELS;
}

static void report(const reproduction *r, cli_output *output, const cli_options *options, verdict found,
                   const glint_compare_result *result)
{
    const char *word = found == SAME ? "same" : found == SAME_PIXELS ? "pixels" : "different";
    if (output->json) {
        glintL_json(output->data, "{\"event\":\"reproduce\",\"file\":%s,\"script\":%s", r->file, options->script);
        fprintf(output->data, ",\"frame\":%s,\"result\":\"%s\"", text_of(r, "glint:frame"), word);
        if (found != SAME)
            glintL_json(output->data, ",\"max_error\":%g,\"reason\":%s", result->max_error, r->reason);
        fputs("}\n", output->data);
        return;
    }
    if (found == SAME)
        fprintf(output->data, "%s: the same, byte for byte\n", r->file);
    else if (found == SAME_PIXELS)
        fprintf(output->data, "%s: the same pixels, other bytes: %s\n", r->file, r->reason);
    else
        fprintf(output->data, "%s: different, by at most %.3g of 1: %s\n", r->file, result->max_error, r->reason);
}

// ---- The command ----

static void clean_up(reproduction *r)
{
    for (int pass = 0; pass <= GLINTL_PASSES_MAX; pass++) {
        if (r->made[pass])
            unlink(r->made[pass]); // normally the only files in the folder; needs no memory to list it
        free(r->made[pass]);
    }
    if (*r->folder && rmdir(r->folder) != 0)
        remove_folder(r->folder);
    glint_picture_destroy(r->picture);
    free(r->params);
    free(r->options);
    free(r->pass);
    free(r->sweep);
}

int cli_reproduce(cli_options *options, cli_output *output, glintL_run *run)
{
    char message[GLINTL_MESSAGE_SIZE] = "";
    glint_compare_result result = { 0 };
    glint_error error;
    reproduction r = { .file = options->file };
    int code = UNREADABLE;
    if (glint_picture_read(r.file, false, &r.picture, &error))
        snprintf(message, sizeof message, "%s", error.message);
    else
        code = make_request(&r, run, message);
    if (!code)
        code = render(&r, options, run, message);
    if (!code) {
        const verdict found = compare(&r, &result, message);
        if (found == UNREADABLE)
            cli_report_error(output, 0, code = GLINTL_EXIT_FAILED, message);
        else
            report(&r, output, options, found, &result);
        clean_up(&r);
        return code ? code : (int)found;
    }
    if (run->interrupted)
        cli_report_error(output, 0, 128 + (int)run->interrupted, "interrupted");
    else
        cli_report_error(output, 0, code, message);
    clean_up(&r);
    return code;
}
