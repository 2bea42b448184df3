/// A program as text.
#include "engine/base/number.h"
#include "engine/render/program/program.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct text {
    char *bytes;
    size_t size, capacity;
    bool failed;
} text;

static __attribute__((format(printf, 2, 3))) void put(text *t, const char *format, ...)
{
    va_list args;
    if (t->capacity - t->size < 256) {
        char *bytes = t->failed ? NULL : realloc(t->bytes, t->capacity + t->capacity / 2 + 1024);
        t->failed = !bytes;
        if (t->failed)
            return;
        t->bytes = bytes;
        t->capacity += t->capacity / 2 + 1024;
    }
    va_start(args, format);
    t->size += (size_t)glint_print_list(t->bytes + t->size, 256, format, args);
    va_end(args);
}

/// Writes the shortest text that reads back as the same number.
static void put_number(text *t, double number)
{
    char shortest[40];
    for (int digits = 1; digits <= 17; digits++) {
        glint_print(shortest, sizeof shortest, "%.*g", digits, number);
        if (glint_read_double(shortest, NULL) == number)
            break;
    }
    put(t, " %s", shortest);
}

static void put_slot(text *t, const glint_program_code *code, uint32_t row)
{
    if (row >= GLINT_ROW_NUMBER)
        put_number(t, code->numbers[row - GLINT_ROW_NUMBER][0]);
    else if (row >= GLINT_ROW_INPUT)
        put(t, " %s", glint_input_name((glint_input)(row - GLINT_ROW_INPUT)));
    else
        put(t, " r%u", row);
}

char *glint_program_listing(const glint_program *program)
{
    if (!program)
        return NULL;
    const glint_program_code *code = &program->code;
    text t = { 0 };
    for (uint32_t at = 0; at < code->length; at++) {
        const glint_instruction *in = &code->instructions[at];
        const glint_op_info *info = glint_op_info_of((glint_op)in->op);
        for (uint32_t k = 0; k < info->results; k++)
            put(&t, "r%u ", in->out[k]);
        put(&t, "= %s", info->name);
        if (in->op >= GLINT_OP_TEXEL)
            put(&t, " t%u", in->texture);
        for (uint32_t k = 0; k < info->operands; k++)
            put_slot(&t, code, in->in[k]);
        put(&t, "\n");
    }
    put(&t, "return");
    for (uint32_t k = 0; k < code->output_count; k++)
        put_slot(&t, code, code->outputs[k]);
    put(&t, "\n");
    if (t.failed)
        free(t.bytes);
    return t.failed ? NULL : t.bytes;
}
