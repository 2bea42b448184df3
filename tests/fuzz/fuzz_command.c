/// Reads the lines of the input as the words of a command line. The result is options, or a message of one line.
#include "bindings/command/cli.h"
#include "tests/fuzz/fuzz.h"

#include <getopt.h>
#include <string.h>

#define WORDS_MAX 64

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1), *words[WORDS_MAX + 2] = { "glint" }, message[GLINTL_MESSAGE_SIZE] = "";
    int count = 1;
    cli_options options;
    FUZZ_CHECK(text, "out of memory");
    memcpy(text, data, size);
    text[size] = 0;
    for (char *at = text; at && count <= WORDS_MAX;) {
        words[count++] = at;
        at = strchr(at, '\n');
        if (at)
            *at++ = 0;
    }
    optind = 0; // restarts getopt
    if (!cli_read_options(count, words, &options, message)) {
        FUZZ_CHECK(*message && memchr(message, 0, sizeof message), "a message");
        FUZZ_CHECK(!strchr(message, '\n'), "a message of one line: %s", message);
    }
    cli_free_options(&options);
    free(text);
    return 0;
}
