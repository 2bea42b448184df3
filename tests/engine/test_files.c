/// Image files: PNG, atomic writes, the writer.
#include "engine/glint_compare.h"
#include "tests/engine/cases/image_case.h"

#include <png.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>

// ---- PNG ----------------------------------------------------------------------------------------------------------

/// Reads the file with libpng's simplified API and compares.
static void check_by_libpng(const char *path, const glint_image *image, const glint_write_desc *desc)
{
    glint_bytes bytes = read_ok(path);
    glint_png png = {0};
    glint_error error = {0};
    if (glint_png_decode(bytes.data, bytes.size, &png, &error))
        fail_msg("%s", error.message);
    assert_int_equal(png.width, image->width);
    assert_int_equal(png.height, image->height);
    assert_int_equal(png.channels, 3);
    assert_int_equal(png.bits, desc->tone.bits);
    const glint_tone_table *table;
    assert_int_equal(glint_tone_table_shared(&desc->tone, &table, NULL), GLINT_OK);
    size_t count = (size_t)png.width * (size_t)png.height * 3;
    for (size_t i = 0; i < count; i++) {
        unsigned want = code_of(table, image->plane[desc->pass][i % 3][i / 3]);
        unsigned got = png.bits == 16 ? ((uint16_t *)png.codes)[i] : ((uint8_t *)png.codes)[i];
        assert_int_equal(got, want);
    }
    if (png.bits == 8 && desc->tone.transfer == GLINT_TRANSFER_SRGB) { // the simplified API would convert other files
        png_image simple = {.version = PNG_IMAGE_VERSION};
        assert_true(png_image_begin_read_from_memory(&simple, bytes.data, bytes.size));
        simple.format = PNG_FORMAT_RGB;
        uint8_t *codes = malloc(PNG_IMAGE_SIZE(simple));
        assert_true(png_image_finish_read(&simple, NULL, codes, 0, NULL));
        assert_memory_equal(codes, png.codes, count);
        free(codes);
    }
    free(png.codes);
    free(bytes.data);
}

static void test_png_round_trip(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {5, 3}, {64, 48}, {1, 700}, {700, 2}, {640, 480}};
    for (size_t s = 0; s < 6; s++)
        for (int i = 0; i < 16; i++) {
            glint_write_desc desc = describe(in_folder("round.png"));
            desc.tone.bits = i & 1 ? 16 : 8;
            desc.tone.transfer = i & 2 ? GLINT_TRANSFER_LINEAR : GLINT_TRANSFER_SRGB;
            desc.encode = i & 4 ? GLINT_ENCODE_SMALL : GLINT_ENCODE_FAST;
            desc.pass = i & 8 ? GLINT_PASS_SPECULAR : GLINT_PASS_BEAUTY;
            glint_image *image = make_image(sizes[s][0], sizes[s][1], i & 1 ? NULL : &desc.tone);
            write_ok(image, &desc);
            check_by_libpng(desc.path, image, &desc);
            assert_true(glint_file_has_key(desc.path, KEY));
            assert_false(glint_file_has_key(desc.path, "0123456789abcdef0123456789abcdee"));
            glint_image_release(image);
        }
    assert_int_equal(files_in(folder), 1);
}

static void test_png_bytes_repeat(void **state)
{
    (void)state;
    glint_image *image = make_image(640, 480, NULL);
    for (int encode = 0; encode < 2; encode++) {
        glint_write_desc desc = describe(in_folder("a.png"));
        desc.encode = (glint_encode)encode;
        write_ok(image, &desc);
        desc.path = in_folder("b.png");
        write_ok(image, &desc);
        glint_bytes a = read_ok(in_folder("a.png")), b = read_ok(in_folder("b.png"));
        assert_int_equal(a.size, b.size);
        assert_memory_equal(a.data, b.data, a.size);
        free(a.data);
        free(b.data);
    }
    glint_image_release(image);
}

static void test_png_speed(void **state)
{
    (void)state;
    glint_tone_desc tone = glint_tone_desc_default();
    glint_image *image = make_image(1920, 1080, &tone);
    for (int encode = 0; encode < 2; encode++) {
        glint_write_desc desc = describe("/dev/null");
        desc.encode = (glint_encode)encode;
        double best = INFINITY;
        desc.path = in_folder("speed.png");
        glint_writer *writer;
        glint_write_result result;
        assert_int_equal(glint_writer_create(2, 1, &writer, NULL), GLINT_OK);
        for (int i = 0; i < 7; i++) {
            assert_int_equal(glint_writer_submit(writer, image, &desc, NULL, NULL), GLINT_OK);
            assert_true(glint_writer_collect(writer, true, &result));
            assert_int_equal(result.status, GLINT_OK);
            best = result.encode_ms < best ? result.encode_ms : best;
        }
        glint_writer_destroy(writer);
        struct stat info;
        assert_int_equal(stat(desc.path, &info), 0);
        print_message("1080p by %s: %.1f ms, %ld bytes\n", glint_encoder_name(desc.encode), best, (long)info.st_size);
    }
    glint_image_release(image);
}

static void spoil(const char *path, const glint_bytes *bytes, size_t size, size_t flip)
{
    uint8_t *copy = malloc(size + 1);
    memcpy(copy, bytes->data, size);
    if (flip < size)
        copy[flip] ^= 4;
    assert_int_equal(glint_file_write(path, copy, size, NULL), GLINT_OK);
    free(copy);
}

static void test_png_spoilt(void **state)
{
    (void)state;
    glint_image *image = make_image(16, 12, NULL);
    glint_write_desc desc = describe(in_folder("whole.png"));
    write_ok(image, &desc);
    glint_bytes bytes = read_ok(desc.path);
    const char *path = in_folder("spoilt.png");
    for (size_t cut = 0; cut < bytes.size; cut++) {
        spoil(path, &bytes, cut, SIZE_MAX);
        assert_false(glint_file_has_key(path, KEY));
        glint_png png;
        glint_error error;
        assert_int_equal(glint_png_decode(bytes.data, cut, &png, &error), GLINT_ERR_FORMAT);
    }
    for (size_t flip = 0; flip < bytes.size; flip++) {
        spoil(path, &bytes, bytes.size, flip);
        assert_false(glint_file_has_key(path, KEY));
        glint_compare_result result;
        glint_status status = glint_compare_files(desc.path, path, NULL, &result, NULL);
        assert_true(status == GLINT_ERR_FORMAT);
    }
    assert_false(glint_file_has_key(in_folder("none.png"), KEY));
    free(bytes.data);
    glint_image_release(image);
}

static void test_png_text(void **state)
{
    (void)state;
    glint_image *image = make_image(4, 4, NULL);
    static char huge[70000];
    memset(huge, 'x', sizeof huge - 1);
    const glint_text bad[] = {{"", "v"},   {" a", "v"}, {"a  b", "v"}, {"a\n", "v"},
                              {NULL, "v"}, {"k", NULL}, {"k", huge}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        glint_write_desc desc = describe(in_folder("text.png"));
        desc.text = &bad[i];
        desc.text_count = 1;
        glint_error error;
        assert_int_equal(glint_image_write(image, &desc, &error), GLINT_ERR_INVALID);
        assert_non_null(strstr(error.message, "text"));
    }
    assert_int_equal(files_in(folder), 0);
    const glint_text odd = {"Comment", "caf\xc3\xa9 \xe2\x82\xac\x01 z"};
    glint_write_desc desc = describe(in_folder("text.png"));
    desc.text = &odd;
    desc.text_count = 1;
    write_ok(image, &desc);
    glint_bytes bytes = read_ok(desc.path);
    assert_true(glint_png_has_text(bytes.data, bytes.size, "Comment", "caf\xe9 ?? z"));
    free(bytes.data);
    glint_image_release(image);
}

// ---- Files --------------------------------------------------------------------------------------------------------

static void check_refused(const char *path, glint_status want, const char *reason)
{
    glint_error error = {0};
    assert_int_equal(glint_file_write(path, "0123456789", 10, &error), want);
    char message[400];
    snprintf(message, sizeof message, "%s: %s", path, reason);
    assert_string_equal(error.message, message);
}

static void test_file_write(void **state)
{
    (void)state;
    assert_int_equal(glint_file_write(in_folder("one/two//three/f"), "abc", 3, NULL), GLINT_OK);
    glint_bytes bytes = read_ok(in_folder("one/two/three/f"));
    assert_int_equal(bytes.size, 3);
    free(bytes.data);
    check_refused("/dev/full", GLINT_ERR_NO_SPACE, "No space left on device");
    struct stat info;
    assert_int_equal(stat("/dev/full", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
    check_refused(in_folder("one"), GLINT_ERR_IO, "Is a directory");
    check_refused(in_folder("one/two/three/f/g"), GLINT_ERR_IO, "Not a directory");
    check_refused("/proc/none/x.png", GLINT_ERR_IO, "No such file or directory");
    assert_int_equal(symlink("one/two/three/f", in_folder("link")), 0);
    assert_int_equal(glint_file_write(in_folder("link"), "defg", 4, NULL), GLINT_OK);
    assert_int_equal(lstat(in_folder("link"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(stat(in_folder("one/two/three/f"), &info), 0);
    assert_int_equal(info.st_size, 4);
    if (geteuid() != 0) { // root can write anywhere
        chmod(in_folder("one"), 0555);
        check_refused(in_folder("one/g"), GLINT_ERR_IO, "Permission denied");
        chmod(in_folder("one"), 0755);
    }
    assert_int_equal(files_in(in_folder("one/two/three")), 1);
    assert_int_equal(files_in(folder), 2);
}

static void *drain(void *user)
{
    glint_bytes *bytes = user;
    FILE *pipe = fopen(in_folder("pipe"), "rb");
    if (!pipe || !glint_bytes_reserve(bytes, 1 << 21))
        return NULL;
    bytes->size = fread(bytes->data, 1, bytes->capacity, pipe);
    fclose(pipe);
    return user;
}

static void refuses(const char *path, const char *reason)
{
    glint_bytes bytes = { 0 };
    glint_error error;
    assert_int_equal(glint_file_read(path, 1 << 24, &bytes, &error), GLINT_ERR_IO);
    assert_non_null(strstr(error.message, reason));
    assert_int_equal(glint_file_read_picture(path, &bytes, &error), GLINT_ERR_IO);
    assert_non_null(strstr(error.message, reason));
    assert_null(bytes.data);
}

static void test_file_pipe(void **state)
{
    (void)state;
    const char *path = in_folder("pipe");
    assert_int_equal(mkfifo(path, 0600), 0);
    glint_bytes bytes = {0};
    pthread_t thread;
    void *done;
    uint8_t *data = calloc(1, 1 << 20);
    assert_int_equal(pthread_create(&thread, NULL, drain, &bytes), 0);
    assert_int_equal(glint_file_write(path, data, 1 << 20, NULL), GLINT_OK);
    pthread_join(thread, &done);
    assert_non_null(done);
    assert_int_equal(bytes.size, 1 << 20);
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    assert_true(S_ISFIFO(info.st_mode));
    refuses(path, "pipe: a file expected, got a pipe"); // refuses at once, without waiting for the pipe's other end
    refuses("/dev/zero", "/dev/zero: a file expected, got a device");
    refuses(folder, "Is a directory");
    free(bytes.data);
    free(data);
}

static void test_file_limit(void **state)
{
    (void)state;
    struct rlimit old, small;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(glint_file_write(in_folder("kept"), "old", 3, NULL), GLINT_OK);
    getrlimit(RLIMIT_FSIZE, &old);
    small = (struct rlimit){4, old.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    glint_error error = {0};
    glint_status status = glint_file_write(in_folder("kept"), "0123456789", 10, &error);
    setrlimit(RLIMIT_FSIZE, &old);
    assert_int_equal(status, GLINT_ERR_IO);
    assert_non_null(strstr(error.message, "kept: File too large"));
    assert_int_equal(files_in(folder), 1);
    glint_bytes bytes = read_ok(in_folder("kept"));
    assert_int_equal(bytes.size, 3); // the file is unchanged
    free(bytes.data);
}

// ---- Writer -------------------------------------------------------------------------------------------------------

static void test_writer_order(void **state)
{
    (void)state;
    glint_image *image = make_image(64, 48, NULL);
    glint_writer *writer;
    glint_write_result result;
    static int number[20];
    assert_int_equal(glint_writer_create(0, 1, &writer, NULL), GLINT_ERR_INVALID);
    assert_int_equal(glint_writer_create(3, -1, &writer, NULL), GLINT_ERR_INVALID);
    assert_int_equal(glint_writer_create(3, 1025, &writer, NULL), GLINT_ERR_INVALID);
    assert_int_equal(glint_writer_create(3, 0, &writer, NULL), GLINT_OK);
    assert_false(glint_writer_collect(writer, true, &result));
    int collected = 0;
    for (int i = 0; i < 20; i++) {
        char name[32];
        snprintf(name, sizeof name, "f%02d.png", i);
        char *path = strdup(i == 5 ? "/dev/full" : in_folder(name));
        if (i == 5)
            strcpy(path, "/dev/fu");
        glint_write_desc desc = describe(path);
        assert_int_equal(glint_writer_submit(writer, image, &desc, &number[i], NULL), GLINT_OK);
        memset(path, 'x', strlen(path)); // the writer must have copied the description
        free(path);
        while (glint_writer_collect(writer, false, &result))
            assert_ptr_equal(result.user, &number[collected++]);
    }
    while (glint_writer_collect(writer, true, &result)) {
        assert_ptr_equal(result.user, &number[collected]);
        collected++;
    }
    assert_int_equal(collected, 20);
    assert_int_equal(files_in(folder), 19); // 19: one of the names has no extension
    glint_writer_destroy(writer);
    assert_int_equal(atomic_load(&image->references), 1);
    glint_image_release(image);
}

/// Files are synced to disk several at a time. When several submissions have one path, in any spelling, the last
/// one wins, even if it finishes first.
static void test_writer_one_path(void **state)
{
    (void)state;
    glint_tone_desc tone = glint_tone_desc_default();
    glint_image *large = make_image(1500, 1000, &tone), *small = make_image(3, 2, &tone);
    glint_writer *writer;
    glint_write_result result;
    struct stat info;
    glint_write_desc desc = describe(in_folder("alone.png"));
    write_ok(small, &desc);
    assert_int_equal(stat(in_folder("alone.png"), &info), 0);
    const long want = (long)info.st_size;
    static const char *const spellings[] = { "again.png", "./again.png", "link.png", "made/..//again.png" };
    assert_int_equal(symlink("./again.png", in_folder("link.png")), 0); // a dangling link at first
    assert_int_equal(glint_writer_create(16, 1, &writer, NULL), GLINT_OK);
    for (int i = 0; i < 20; i++) {
        desc.path = in_folder("again.png");
        unlink(desc.path);
        assert_int_equal(glint_writer_submit(writer, large, &desc, NULL, NULL), GLINT_OK);
        desc.path = in_folder(spellings[i % 4]);
        assert_int_equal(glint_writer_submit(writer, small, &desc, NULL, NULL), GLINT_OK);
        for (int k = 0; k < 2; k++) {
            assert_true(glint_writer_collect(writer, true, &result));
            assert_int_equal(result.status, GLINT_OK);
        }
        assert_int_equal(stat(in_folder("again.png"), &info), 0);
        assert_int_equal((long)info.st_size, want);
    }
    glint_writer_destroy(writer);
    glint_image_release(large);
    glint_image_release(small);
}

static void test_writer_cancel(void **state)
{
    (void)state;
    glint_image *image = make_image(640, 480, NULL);
    glint_writer *writer;
    glint_write_result result;
    assert_int_equal(glint_writer_create(100, 1, &writer, NULL), GLINT_OK);
    for (int i = 0; i < 50; i++) {
        char name[32];
        snprintf(name, sizeof name, "c%02d.png", i);
        glint_write_desc desc = describe(in_folder(name));
        assert_int_equal(glint_writer_submit(writer, image, &desc, NULL, NULL), GLINT_OK);
    }
    glint_writer_cancel(writer);
    int done = 0, cancelled = 0;
    while (glint_writer_collect(writer, true, &result)) {
        done += result.status == GLINT_OK;
        cancelled += result.status == GLINT_ERR_CANCELLED;
        assert_true(result.status == GLINT_OK || cancelled > 0);
    }
    assert_int_equal(done + cancelled, 50);
    assert_int_equal(files_in(folder), done);
    glint_writer_destroy(writer);
    glint_writer_destroy(NULL);
    assert_int_equal(atomic_load(&image->references), 1);
    glint_image_release(image);
}

/// An unchanged picture is written again without deflating it again. The file does not depend on the number of threads.
static void test_writer_reuse(void **state)
{
    (void)state;
    glint_tone_desc tone = glint_tone_desc_default();
    glint_image *image = make_image(1000, 500, &tone);
    for (size_t i = 0; i < glint_image_stamps(image); i++)
        image->row_stamp[i] = i + 1;
    write_ok(image, &(glint_write_desc) { .struct_size = sizeof(glint_write_desc), .path = in_folder("want.png"), .tone = tone});
    glint_bytes want = read_ok(in_folder("want.png"));
    for (int threads = 1; threads <= 3; threads++) {
        glint_writer *writer;
        assert_int_equal(glint_writer_create(1, threads, &writer, NULL), GLINT_OK);
        for (int i = 0; i < 3; i++) {
            glint_write_result result;
            glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = in_folder("got.png"), .tone = tone};
            assert_int_equal(glint_writer_submit(writer, image, &desc, NULL, NULL), GLINT_OK);
            assert_true(glint_writer_collect(writer, true, &result));
            assert_int_equal(result.status, GLINT_OK);
            assert_true(result.reused == (i ? 1 : 0));
            glint_bytes got = read_ok(desc.path);
            assert_int_equal(got.size, want.size);
            assert_memory_equal(got.data, want.data, got.size);
            free(got.data);
        }
        glint_writer_destroy(writer);
    }
    free(want.data);
    glint_image_release(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_FOLDER(test_png_round_trip), WITH_FOLDER(test_png_bytes_repeat), WITH_FOLDER(test_png_speed),
        WITH_FOLDER(test_png_spoilt),     WITH_FOLDER(test_png_text),         WITH_FOLDER(test_file_write),
        WITH_FOLDER(test_file_pipe),      WITH_FOLDER(test_file_limit),       WITH_FOLDER(test_writer_order),
        WITH_FOLDER(test_writer_cancel),  WITH_FOLDER(test_writer_reuse),     WITH_FOLDER(test_writer_one_path),
    };
    glint_tone_store_open();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    glint_tone_store_close();
    return failed;
}
