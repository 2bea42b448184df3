// Runs a command repeatedly, and makes each of its allocations or writes fail in turn.
//   every KIND LIBRARY FOLDER COMMAND...    KIND: alloc or write; LIBRARY: fail.c's; FOLDER: where COMMAND runs
// COMMAND writes to FOLDER/out, which is empty before each run, and to stdout. A successful run must produce the same
// bytes as the first, fault-free run. A failing run must give the reason ("memory", or "space" with exit code 75),
// and must leave only complete files in out. From the environment: EVERY_STEP runs only every n-th point.
// Prints a line for each wrong point, then "POINTS points, SAME the same, REFUSED refused, WRONG wrong".
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define FILES_MAX 32
#define LIMIT_S 30

typedef struct bytes {
    char *data;
    size_t size;
} bytes;

typedef struct made { // the files and the output that one run made
    int status;
    long count;
    bytes out, err;
    char *names[FILES_MAX];
    bytes files[FILES_MAX];
    int file_count;
} made;

typedef struct plan {
    const char *kind, *library, *folder;
    char **command;
    char out[400], out_path[440], err_path[440];
} plan;

static void die(const char *what)
{
    perror(what);
    exit(2);
}

static bytes read_file(const char *path)
{
    bytes all = { malloc(1), 0 };
    FILE *file = fopen(path, "rb");
    if (!file || !all.data)
        die(path);
    for (;;) {
        all.data = realloc(all.data, all.size + 65537);
        if (!all.data)
            die("memory");
        const size_t got = fread(all.data + all.size, 1, 65536, file);
        all.size += got;
        if (got == 0)
            break;
    }
    all.data[all.size] = '\0';
    fclose(file);
    return all;
}

static bool same(const bytes *a, const bytes *b) { return a->size == b->size && memcmp(a->data, b->data, a->size) == 0; }

static void release(made *m)
{
    free(m->out.data);
    free(m->err.data);
    for (int i = 0; i < m->file_count; i++) {
        free(m->names[i]);
        free(m->files[i].data);
    }
}

// Empties `path` and its subfolders. Reads each file into `m` first, unless `m` is NULL. Complete frames of a failed
// film may stay in NAME.frames, so that the next run can continue.
static void empty(const char *path, made *m)
{
    char name[700];
    DIR *folder = opendir(path);
    if (!folder)
        die(path);
    for (struct dirent *entry; (entry = readdir(folder));) {
        struct stat info;
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        if (lstat(name, &info) == 0 && S_ISDIR(info.st_mode)) {
            empty(name, m);
            rmdir(name);
            continue;
        }
        const char *ending = strrchr(path, '.');
        const bool goes_on = ending && strcmp(ending, ".frames") == 0 && !strstr(name, ".tmp");
        if (m && !goes_on && m->file_count < FILES_MAX) {
            m->names[m->file_count] = strdup(name + strlen(path) + 1);
            m->files[m->file_count++] = read_file(name);
        }
        unlink(name);
    }
    closedir(folder);
}

static void run_child(const plan *p, long at, int fd)
{
    char number[32], where[32];
    snprintf(number, sizeof number, "%ld", at);
    snprintf(where, sizeof where, "%d", fd);
    setenv("FAULT_KIND", p->kind, 1);
    setenv("FAULT_AT", number, 1);
    setenv("FAULT_FD", where, 1);
    setenv("TMPDIR", p->out, 1);
    setenv("LD_PRELOAD", p->library, 1);
    const int in = open("/dev/null", O_RDONLY), out = open(p->out_path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    const int err = open(p->err_path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (in < 0 || out < 0 || err < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0 ||
        chdir(p->folder) != 0)
        _exit(126);
    alarm(LIMIT_S);
    execv(p->command[0], p->command);
    _exit(127);
}

static made run(const plan *p, long at)
{
    made m = { 0 };
    int ends[2];
    char text[32] = "";
    empty(p->out, NULL);
    if (pipe(ends) != 0)
        die("pipe");
    const pid_t child = fork();
    if (child == 0)
        run_child(p, at, ends[1]);
    close(ends[1]);
    if (child < 0 || waitpid(child, &m.status, 0) != child)
        die("fork");
    if (read(ends[0], text, sizeof text - 1) > 0)
        m.count = atol(text);
    close(ends[0]);
    m.out = read_file(p->out_path);
    m.err = read_file(p->err_path);
    empty(p->out, &m);
    return m;
}

static const bytes *find(const made *m, const char *name)
{
    for (int i = 0; i < m->file_count; i++)
        if (strcmp(m->names[i], name) == 0)
            return &m->files[i];
    return NULL;
}

// Returns NULL if the run is correct, otherwise the error.
static const char *judge(const plan *p, const made *want, const made *got, bool *refused)
{
    const bool is_alloc = strcmp(p->kind, "alloc") == 0;
    *refused = false;
    if (!WIFEXITED(got->status))
        return "ended by a signal";
    for (int i = 0; i < got->file_count; i++) {
        const bytes *whole = find(want, got->names[i]);
        if (!whole || !same(whole, &got->files[i]))
            return whole ? "a file with other bytes" : "a file that should not be there";
    }
    const int code = WEXITSTATUS(got->status);
    if (code == WEXITSTATUS(want->status)) {
        if (!same(&want->out, &got->out))
            return "success, with other words on stdout";
        return got->file_count == want->file_count ? NULL : "success, and a file is missing";
    }
    *refused = true;
    if (!strcasestr(got->err.data, is_alloc ? "memory" : "space"))
        return "failed without saying why";
    return is_alloc || code == 75 ? NULL : "failed with another code than 75";
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: every alloc|write LIBRARY FOLDER COMMAND...\n");
        return 2;
    }
    plan p = { .kind = argv[1], .library = argv[2], .folder = argv[3], .command = argv + 4 };
    snprintf(p.out, sizeof p.out, "%s/out", p.folder);
    snprintf(p.out_path, sizeof p.out_path, "%s/stdout", p.folder);
    snprintf(p.err_path, sizeof p.err_path, "%s/stderr", p.folder);
    const char *step_text = getenv("EVERY_STEP");
    const long step = step_text ? atol(step_text) : 1;
    made want = run(&p, 0);
    if (want.status != 0 || want.count == 0) {
        printf("without a fault: status %d, %ld points: %s\n", want.status, want.count, want.err.data);
        return 1;
    }
    long points = 0, same_count = 0, refused_count = 0, wrong_count = 0;
    for (long at = 1; at <= want.count; at += step, points++) {
        bool refused;
        made got = run(&p, at);
        const char *wrong = judge(&p, &want, &got, &refused);
        if (wrong && wrong_count++ < 20)
            printf("%ld of %ld: %s; status %d; %.200s\n", at, want.count, wrong, got.status, got.err.data);
        same_count += !wrong && !refused;
        refused_count += !wrong && refused;
        release(&got);
    }
    printf("%ld points, %ld the same, %ld refused, %ld wrong\n", points, same_count, refused_count, wrong_count);
    release(&want);
    return wrong_count > 0;
}
