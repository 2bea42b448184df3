// The values of a knob of glint cost: numbers or words, including the script's own value.
#include <string.h>

#include "bindings/cost/cost.h"

void cost_list_numbers(const double *numbers, int count, double own, cost_values *out)
{
    int at = 0;
    while (at < count && numbers[at] < own)
        at++;
    const bool is_new = at == count || numbers[at] != own;
    for (int i = 0; i < count; i++)
        out->value[i + (is_new && i >= at)].number = numbers[i];
    out->value[at].number = own;
    out->count = count + is_new;
    out->own = out->base = at;
}

void cost_list_words(const char *const *words, int count, int own, cost_values *out)
{
    for (int i = 0; i < count; i++)
        out->value[i].text = words[i];
    out->count = count;
    out->own = out->base = own;
}

int cost_find_word(const cost_value value, const char *const *words, int count)
{
    int at = 0;
    while (at < count - 1 && strcmp(words[at], value.text) != 0)
        at++;
    return at;
}

void cost_value_text(cost_value value, char out[32])
{
    if (value.text)
        snprintf(out, 32, "%s", value.text);
    else
        glintL_format_number(out, value.number);
}
