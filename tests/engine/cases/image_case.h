/// Shared by the tests of images: a folder for a test's files, and a picture with every pass.
#ifndef GLINT_TESTS_IMAGE_CASE_H
#define GLINT_TESTS_IMAGE_CASE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "engine/files/picture/file.h"
#include "engine/files/picture/png.h"
#include "engine/film/image.h"
#include "engine/film/tone.h"

#define KEY "0123456789abcdef0123456789abcdef"

static char folder[64]; ///< folder of this run, empty between tests

static inline const char *in_folder(const char *name)
{
    static char path[8][256];
    static int turn;
    char *out = path[turn++ % 8];
    snprintf(out, sizeof path[0], "%s/%s", folder, name);
    return out;
}

static inline int files_in(const char *path)
{
    int count = 0;
    DIR *dir = opendir(path);
    assert_non_null(dir);
    for (struct dirent *e = readdir(dir); e; e = readdir(dir))
        count += strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0;
    closedir(dir);
    return count;
}

static inline double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static inline int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/glint-image-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static const uint32_t every_pass = (1u << GLINT_PASS_COUNT) - 1;

/// A picture with a smooth beauty pass, depths with a background, normals and ids.
static inline glint_image *make_image(int width, int height, const glint_tone_desc *codes)
{
    glint_image *image = NULL;
    assert_int_equal(glint_image_create(width, height, every_pass, codes, &image, NULL), GLINT_OK);
    size_t count = (size_t)width * (size_t)height;
    for (size_t i = 0; i < count; i++) {
        double x = (double)(i % (size_t)width) / width, y = (double)(i / (size_t)width) / height;
        bool hit = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) < 0.2;
        for (int c = 0; c < 3; c++) {
            for (int pass = GLINT_PASS_BEAUTY; pass <= GLINT_PASS_SPECULAR; pass++)
                image->plane[pass][c][i] = (float)(hit ? x * (c + 1) / 3 : 0.05);
            image->plane[GLINT_PASS_NORMAL][c][i] = hit ? (c == 2 ? 1.0f : 0.0f) : 0;
        }
        image->plane[GLINT_PASS_DEPTH][0][i] = hit ? (float)(5 + x) : INFINITY;
        image->plane[GLINT_PASS_OBJECT_ID][0][i] = hit ? (float)(1 + i % 7) : 0;
        image->plane[GLINT_PASS_REFINED][0][i] = i % 3 == 0;
        image->plane[GLINT_PASS_OUTLINE][0][i] = hit && i % 5 == 0;
        image->plane[GLINT_PASS_ALPHA][0][i] = hit ? (float)(1 + i % 4) / 4 : 0;
    }
    if (codes && codes->bits == 8) {
        const glint_tone_table *table;
        glint_tone_store_open();
        assert_int_equal(glint_tone_table_shared(codes, &table, NULL), GLINT_OK);
        float **p = image->plane[GLINT_PASS_BEAUTY];
        glint_tone_row(table, glint_tone_gain(codes), (const float *const[3]) {p[0], p[1], p[2]}, NULL, (const int[2]) {0, 0}, count,
                       image->codes, NULL);
        glint_tone_store_close();
    }
    return image;
}

static inline glint_write_desc describe(const char *path)
{
    static const glint_text text[] = {{"Software", "glint"}, {GLINT_PNG_KEY, KEY}};
    return (glint_write_desc) { .struct_size = sizeof(glint_write_desc),
        .path = path, .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default(), .text = text, .text_count = 2};
}

static inline void write_ok(const glint_image *image, const glint_write_desc *desc)
{
    glint_error error = {0};
    if (glint_image_write(image, desc, &error))
        fail_msg("%s", error.message);
}

static inline glint_bytes read_ok(const char *path)
{
    glint_bytes bytes = {0};
    assert_int_equal(glint_file_read(path, 1 << 28, &bytes, NULL), GLINT_OK);
    return bytes;
}

static inline uint16_t code_of(const glint_tone_table *table, float x)
{
    uint16_t codes[3];
    glint_tone_row(table, 1, (const float *const[3]) {&x, &x, &x}, NULL, (const int[2]) {0, 0}, 1, codes, NULL);
    return table->desc.bits == 8 ? ((const uint8_t *)codes)[1] : codes[1];
}

#define WITH_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)

#endif
