/// The bytes are a text with formulas. A text that glint_line_check accepts has the same runs in every font; its lines
/// are measured and drawn, and all positions are finite.
#include "engine/figures/text/line.h"
#include "tests/fuzz/fuzz.h"

#include <math.h>
#include <string.h>

#define SIDE 64

static void draw(const glint_typeface *typeface, const char *text, size_t size)
{
    static glint_line line;
    static uint8_t coverage[SIDE * SIDE];
    glint_mask mask = { SIDE, SIDE, coverage };
    glint_line_set(typeface, text, size, &line);
    FUZZ_CHECK(line.width >= 0 && line.above >= typeface->above && line.run_count <= GLINT_LINE_RUNS, "%d, %d", line.width, line.above);
    for (int i = 0; i < line.run_count; i++) {
        const glint_run *run = &line.runs[i];
        FUZZ_CHECK(isfinite(run->x) && isfinite(run->y) && run->em > 0 && run->stretch >= 1, "%g, %g", run->x, run->y);
    }
    for (int i = 0; i < line.rule_count; i++)
        FUZZ_CHECK(line.rules[i].width >= 0 && line.rules[i].height >= 1, "%g", line.rules[i].width);
    glint_line_draw(typeface, &line, SIDE / 2 - line.width / 2, SIDE / 2, &mask);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static glint_letters *letters;
    static bool opened;
    char *text = malloc(size + 1);
    glint_error error;
    FUZZ_CHECK(text, "out of memory");
    memcpy(text, data, size);
    text[size] = '\0';
    if (!opened)
        opened = glint_letters_open(&letters, &error) == GLINT_OK;
    if (!glint_line_check("text", text, &error)) {
        const glint_typeface faces[] = { glint_typeface_open(NULL, 26), glint_typeface_open(letters, 17.5) };
        for (const char *at = text; *at;) {
            const size_t line = strcspn(at, "\n");
            for (const char *blank = at; (blank = glint_line_blank(at, blank, at + line)) != NULL; blank++)
                FUZZ_CHECK(*blank == ' ', "%s", at);
            for (int i = 0; i < 2; i++)
                draw(&faces[i], at, line);
            at += line + (at[line] == '\n');
        }
    }
    free(text);
    return 0;
}
