/// glint_writer: one list of jobs in the order of submission. One thread encodes them (with a pool of its own if
/// several threads are allowed). Other threads write the files, several at a time, because a sync waits for the disk
/// and not for a processor.
#include "engine/base/pool.h"
#include "engine/base/status.h"
#include "engine/files/picture/file.h"
#include "engine/files/picture/write.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define FILERS 4 ///< most threads that write files
#define SPARES 4 ///< most buffers cached for later files
#define SPARE_BYTES ((size_t)1 << 24) ///< buffers larger than this are not cached; bytes

typedef enum job_state { JOB_QUEUED, JOB_ENCODING, JOB_ENCODED, JOB_FILING, JOB_DONE } job_state;

typedef struct job {
    struct job *next;
    job_state state;
    glint_image *image; ///< owned until the job is encoded
    glint_write_desc desc; ///< its strings are stored after the job
    char *target; ///< canonical path of the file, see glint_draft_place; owned
    glint_bytes bytes; ///< the encoded file, until it is written; owned
    glint_write_result result;
} job;

struct glint_writer {
    pthread_t encoder, filers[FILERS];
    int filer_count;
    glint_bands *bands; ///< the encoder's
    pthread_mutex_t
        lock; ///< protects all fields below; a job in progress belongs to its thread, except `next` and `state`
    pthread_cond_t to_encode, to_file; ///< signalled when there may be work for the encoder; for a thread that writes
        ///< files
    pthread_cond_t moved; ///< signalled when a job has left a queue, or is done
    job *first, **end; ///< jobs that are submitted and not yet collected
    int waiting[JOB_DONE]; ///< number of jobs that wait to be encoded, and to be written
    int queue_depth; ///< largest number of jobs in each of the two queues
    glint_bytes spare[SPARES]; ///< cached buffers of written files, because touching fresh memory takes longer than
        ///< filling a cached buffer
    int spare_count;
    bool closing; ///< no more jobs will be submitted
    bool encoded_all; ///< closing, and the encoder has no job left
};

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void free_job(job *j)
{
    if (j)
        free(j->target);
    free(j);
}

// ---- The threads --------------------------------------------------------------------------------------------------

static void finish(job *j, glint_status status, const glint_error *error)
{
    j->result.status = status;
    memcpy(j->result.message, error->message, sizeof j->result.message);
}

/// Encodes a job. Returns whether there is a file to write.
static bool encode(job *j, glint_bands *bands)
{
    glint_error error = { 0 };
    const double start = now_ms();
    const glint_status status = glint_image_encode(j->image, &j->desc, bands, &j->bytes, &j->result.reused, &error);
    j->result.encode_ms = now_ms() - start;
    glint_image_release(j->image);
    j->image = NULL;
    finish(j, status, &error);
    return status == GLINT_OK;
}

static void file(job *j)
{
    glint_error error = { 0 };
    const double start = now_ms();
    finish(j, glint_file_write(j->desc.path, j->bytes.data, j->bytes.size, &error), &error);
    j->result.write_ms = now_ms() - start;
}

/// Returns whether an earlier file with the same path is still being written: the last one submitted must win.
static bool is_behind(const glint_writer *writer, const job *j)
{
    for (const job *before = writer->first; before != j; before = before->next)
        if (before->state == JOB_FILING && strcmp(before->target, j->target) == 0)
            return true;
    return false;
}

/// Caches a job's buffer for another job, or frees it.
static void give_back(glint_writer *writer, job *j)
{
    if (j->bytes.data && j->bytes.capacity <= SPARE_BYTES && writer->spare_count < SPARES) {
        writer->spare[writer->spare_count] = j->bytes;
        writer->spare[writer->spare_count++].size = 0;
    } else {
        free(j->bytes.data);
    }
    j->bytes = (glint_bytes) { 0 };
}

/// Starts the next step of the first job that waits in this state, and returns the job. NULL: no job waits.
static job *take(glint_writer *writer, job_state waiting)
{
    job *j = writer->first;
    while (j && (j->state != waiting || (waiting == JOB_ENCODED && is_behind(writer, j))))
        j = j->next;
    if (j) {
        j->state = waiting + 1;
        writer->waiting[waiting]--;
        pthread_cond_broadcast(waiting == JOB_QUEUED ? &writer->moved : &writer->to_encode); // one more fits
    }
    return j;
}

static void move_on(glint_writer *writer, job *j, job_state state)
{
    j->state = state;
    if (state == JOB_ENCODED) {
        writer->waiting[state]++;
    } else {
        give_back(writer, j);
        pthread_cond_broadcast(&writer->moved);
    }
    if (writer->waiting[JOB_ENCODED] > 0) // this job, or one that was behind it
        pthread_cond_signal(&writer->to_file);
}

static void *run_encoder(void *user)
{
    glint_writer *writer = user;
    pthread_mutex_lock(&writer->lock);
    for (;;) {
        job *j = writer->waiting[JOB_ENCODED] < writer->queue_depth ? take(writer, JOB_QUEUED) : NULL;
        if (!j && writer->closing && !writer->waiting[JOB_QUEUED])
            break;
        if (!j) {
            pthread_cond_wait(&writer->to_encode, &writer->lock);
            continue;
        }
        if (writer->spare_count > 0)
            j->bytes = writer->spare[--writer->spare_count];
        pthread_mutex_unlock(&writer->lock);
        const bool encoded = encode(j, writer->bands);
        pthread_mutex_lock(&writer->lock);
        move_on(writer, j, encoded ? JOB_ENCODED : JOB_DONE);
    }
    writer->encoded_all = true;
    pthread_cond_broadcast(&writer->to_file);
    pthread_mutex_unlock(&writer->lock);
    return NULL;
}

static void *run_filer(void *user)
{
    glint_writer *writer = user;
    pthread_mutex_lock(&writer->lock);
    for (;;) {
        job *j = take(writer, JOB_ENCODED);
        if (!j && writer->encoded_all && !writer->waiting[JOB_ENCODED])
            break;
        if (!j) {
            pthread_cond_wait(&writer->to_file, &writer->lock);
            continue;
        }
        pthread_mutex_unlock(&writer->lock);
        file(j);
        pthread_mutex_lock(&writer->lock);
        move_on(writer, j, JOB_DONE);
    }
    pthread_cond_signal(&writer->to_file); // wakes another filer, which then ends too
    pthread_mutex_unlock(&writer->lock);
    return NULL;
}

// ---- Making and ending --------------------------------------------------------------------------------------------

/// Starts a thread with all signals blocked, because the main thread handles them.
static bool start_thread(glint_writer *writer, pthread_t *thread, void *(*run)(void *))
{
    sigset_t all, old;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &old);
    const bool started = pthread_create(thread, NULL, run, writer) == 0;
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    return started;
}

/// Waits until the encoder has finished the queue.
static void close_encoder(glint_writer *writer)
{
    pthread_mutex_lock(&writer->lock);
    writer->closing = true;
    pthread_cond_signal(&writer->to_encode);
    pthread_mutex_unlock(&writer->lock);
    pthread_join(writer->encoder, NULL);
}

static bool start_threads(glint_writer *writer)
{
    if (!start_thread(writer, &writer->encoder, run_encoder))
        return false;
    while (writer->filer_count < FILERS && start_thread(writer, &writer->filers[writer->filer_count], run_filer))
        writer->filer_count++;
    if (writer->filer_count > 0)
        return true;
    close_encoder(writer);
    return false;
}

static void free_writer(glint_writer *writer)
{
    pthread_cond_destroy(&writer->to_encode);
    pthread_cond_destroy(&writer->to_file);
    pthread_cond_destroy(&writer->moved);
    pthread_mutex_destroy(&writer->lock);
    glint_bands_destroy(writer->bands);
    for (int i = 0; i < writer->spare_count; i++)
        free(writer->spare[i].data);
    free(writer);
}

glint_status glint_writer_create(int queue_depth, int threads, glint_writer **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    glint_status status = glint_check_range("queue_depth", queue_depth, 1, 1 << 20, "number 1 .. 1048576", error);
    if (!status)
        status = glint_check_whole("threads", threads, 0, 1024, error);
    if (status)
        return status;
    glint_writer *writer = calloc(1, sizeof *writer);
    if (!writer)
        return glint_fail_nomem(error);
    writer->queue_depth = queue_depth;
    writer->end = &writer->first;
    pthread_mutex_init(&writer->lock, NULL);
    pthread_cond_init(&writer->to_encode, NULL);
    pthread_cond_init(&writer->to_file, NULL);
    pthread_cond_init(&writer->moved, NULL);
    status = glint_bands_create(threads ? threads : glint_pool_processors(), &writer->bands, error);
    if (!status && !start_threads(writer))
        status = glint_fail(error, GLINT_ERR_NOMEM, "no thread for the writer: out of memory, or at the system's limit of threads");
    if (status) {
        free_writer(writer);
        return status;
    }
    *out = writer;
    return GLINT_OK;
}

void glint_writer_destroy(glint_writer *writer)
{
    if (!writer)
        return;
    close_encoder(writer);
    for (int i = 0; i < writer->filer_count; i++)
        pthread_join(writer->filers[i], NULL);
    for (job *j = writer->first; j;) {
        job *next = j->next;
        free_job(j);
        j = next;
    }
    free_writer(writer);
}

// ---- Jobs ---------------------------------------------------------------------------------------------------------

/// Copies a string to *at and moves *at past the copy.
static const char *copy_string(char **at, const char *string)
{
    if (!string)
        return NULL;
    size_t size = strlen(string) + 1;
    char *copy = memcpy(*at, string, size);
    *at += size;
    return copy;
}

static size_t bytes_of(const char *string) { return string ? strlen(string) + 1 : 0; }

static job *make_job(const glint_write_desc *desc)
{
    size_t text_bytes = desc->text_count * sizeof(glint_text);
    size_t bytes = sizeof(job) + text_bytes + bytes_of(desc->path);
    for (size_t i = 0; i < desc->text_count; i++)
        bytes += bytes_of(desc->text[i].keyword) + bytes_of(desc->text[i].value);
    job *j = malloc(bytes);
    if (!j)
        return NULL;
    *j = (job) { .state = JOB_QUEUED, .desc = *desc, .target = glint_draft_place(desc->path) };
    if (!j->target) {
        free(j);
        return NULL;
    }
    glint_text *text = (glint_text *)(j + 1);
    char *at = (char *)(text + desc->text_count);
    j->desc.path = copy_string(&at, desc->path);
    j->desc.text = text;
    for (size_t i = 0; i < desc->text_count; i++) {
        text[i].keyword = copy_string(&at, desc->text[i].keyword);
        text[i].value = copy_string(&at, desc->text[i].value);
    }
    return j;
}

glint_status glint_writer_submit(glint_writer *writer, glint_image *image, const glint_write_desc *given, void *user,
                                 glint_error *error)
{
    GLINT_REFUSE_NULL(writer, error);
    GLINT_REFUSE_NULL(image, error);
    GLINT_TAKE_DESC(glint_write_desc, { 0 });
    job *j = make_job(desc);
    if (!j)
        return glint_fail_nomem(error);
    j->image = glint_image_retain(image);
    j->result.user = user;
    pthread_mutex_lock(&writer->lock);
    while (writer->waiting[JOB_QUEUED] >= writer->queue_depth)
        pthread_cond_wait(&writer->moved, &writer->lock);
    *writer->end = j;
    writer->end = &j->next;
    writer->waiting[JOB_QUEUED]++;
    pthread_cond_signal(&writer->to_encode);
    pthread_mutex_unlock(&writer->lock);
    return GLINT_OK;
}

bool glint_writer_collect(glint_writer *writer, bool wait, glint_write_result *result)
{
    if (!writer || !result)
        return false;
    pthread_mutex_lock(&writer->lock);
    while (wait && writer->first && writer->first->state != JOB_DONE)
        pthread_cond_wait(&writer->moved, &writer->lock);
    job *j = writer->first && writer->first->state == JOB_DONE ? writer->first : NULL;
    if (j) {
        writer->first = j->next;
        if (!writer->first)
            writer->end = &writer->first;
    }
    pthread_mutex_unlock(&writer->lock);
    if (j)
        *result = j->result;
    free_job(j);
    return j != NULL;
}

void glint_writer_cancel(glint_writer *writer)
{
    if (!writer)
        return;
    pthread_mutex_lock(&writer->lock);
    for (job *j = writer->first; j; j = j->next) {
        if (j->state != JOB_QUEUED)
            continue;
        glint_image_release(j->image);
        j->image = NULL;
        j->result.status = GLINT_ERR_CANCELLED;
        snprintf(j->result.message, sizeof j->result.message, "cancelled");
        j->state = JOB_DONE;
    }
    writer->waiting[JOB_QUEUED] = 0;
    pthread_cond_broadcast(&writer->moved);
    pthread_mutex_unlock(&writer->lock);
}
