/// Rows of a long text: every number of threads gives the same rows, and stops at the same line.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/glint_data.h"

enum { ROWS = 60000, LINE = 64 };

typedef struct table {
    char *text;
    size_t length, lines;
    double *wanted; // two numbers a row
    size_t at[ROWS + 1]; // where each row begins
} table;

/// Writes rows "word,x,y". skips: with blank lines and comments between them.
static void write_table(table *t, bool skips)
{
    srand(7);
    t->text = malloc(3 * LINE * ROWS);
    t->wanted = malloc(2 * ROWS * sizeof *t->wanted);
    t->length = t->lines = 0;
    assert_non_null(t->text);
    assert_non_null(t->wanted);
    for (size_t i = 0; i < ROWS; i++) {
        double *v = t->wanted + 2 * i;
        for (int k = rand() % 3; skips && k > 0; k--, t->lines++)
            t->length += (size_t)sprintf(t->text + t->length, k == 2 ? "# 1,2,3\r\n" : " \n");
        v[0] = rand() / 1e9 - 1;
        v[1] = rand() * 1e-20;
        t->at[i] = t->length;
        t->length += (size_t)sprintf(t->text + t->length, "w%zu,%.17g, %.17g \n", i % 3, v[0], v[1]);
        t->lines++;
    }
    t->at[ROWS] = t->length;
}

/// Reads the table with several threads, and compares `rows` rows.
static void check(const table *t, bool skips, size_t rows)
{
    static double x[3 * ROWS], y[3 * ROWS];
    static int64_t index[3 * ROWS];
    glint_error error;
    glint_words *words;
    assert_int_equal(glint_words_create(&words, &error), GLINT_OK);
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(glint_words_add(words, (const char *[]) { "w0", "w1", "w2" }[i], 2, i, &error), GLINT_OK);
    const glint_column columns[] = {
        { .field = 0, .kind = GLINT_COLUMN_WORD, .words = words, .indices = index },
        { .field = 1, .kind = GLINT_COLUMN_NUMBER, .numbers = x },
        { .field = 2, .kind = GLINT_COLUMN_VALUE, .numbers = y },
    };
    for (int threads = 0; threads <= 20; threads = 2 * threads + 1) {
        const glint_rows_desc desc = { .separator = ',', .field_count = 3, .skips = skips, .columns = columns,
                                       .column_count = 3, .threads = threads };
        size_t used, lines;
        assert_int_equal(glint_rows_read(&desc, t->text, t->length, SIZE_MAX, &used, &lines), rows);
        if (rows == ROWS)
            assert_int_equal(lines, t->lines);
        assert_true(used <= t->at[rows] && (rows == 0 || used > t->at[rows - 1]));
        for (size_t i = 0; i < rows; i++)
            if (index[i] != (int64_t)(i % 3) || x[i] != t->wanted[2 * i] || y[i] != t->wanted[2 * i + 1])
                fail_msg("row %zu with %d threads: %g %g", i, threads, x[i], y[i]);
    }
    glint_words_destroy(words);
}

static void test_threads(void **state)
{
    table *t = malloc(sizeof *t);
    (void)state;
    assert_non_null(t);
    for (int skips = 0; skips < 2; skips++) {
        write_table(t, skips);
        check(t, skips, ROWS);
        for (size_t broken = ROWS - 1; broken > 0; broken = broken > ROWS / 5 ? broken - ROWS / 5 : 0) {
            t->text[t->at[broken]] = 'v'; // an unknown word
            check(t, skips, broken);
        }
        free(t->text);
        free(t->wanted);
    }
    free(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_threads) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
