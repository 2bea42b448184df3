// Pictures in a terminal: by the kitty graphics protocol, sixels, or coloured half blocks.
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "bindings/run/carried.h"
#include "bindings/watch/watch.h"

#define ANSWER_MS 150 // a terminal that has not answered by then does not support the query

// ---- Queries to the terminal ----

// Queries support of the kitty protocol, then the terminal's type, which every terminal answers.
static size_t query(int terminal, char *answer, size_t room)
{
    static const char question[] = "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\\033[c";
    struct pollfd wait = { .fd = terminal, .events = POLLIN };
    size_t size = 0;
    if (write(terminal, question, sizeof question - 1) != (ssize_t)sizeof question - 1)
        return 0;
    while (size < room - 1 && poll(&wait, 1, ANSWER_MS) > 0) {
        ssize_t got = read(terminal, answer + size, room - 1 - size);
        if (got <= 0)
            break;
        size += (size_t)got;
        const char *last = memchr(answer, '[', size);
        if (last && memchr(last, 'c', size - (size_t)(last - answer)))
            break;
    }
    return size;
}

// Returns whether an answer such as "\033[?62;4;6c" lists feature 4, sixel graphics.
static bool has_sixel(const char *answer)
{
    const char *at = strstr(answer, "\033[?");
    for (at = at ? strchr(at, ';') : NULL; at; at = strchr(at + 1, ';'))
        if (strtol(at + 1, NULL, 10) == 4)
            return true;
    return false;
}

static watch_graphics find_graphics(void)
{
    struct termios before, raw;
    char answer[256] = "";
    int terminal = open("/dev/tty", O_RDWR | O_CLOEXEC | O_NOCTTY);
    if (terminal < 0)
        return WATCH_BLOCKS;
    bool foreground = tcgetpgrp(terminal) == getpgrp(); // a query from the background would stop the process
    if (foreground && tcgetattr(terminal, &before) == 0) {
        raw = before;
        raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
        tcsetattr(terminal, TCSANOW, &raw);
        answer[query(terminal, answer, sizeof answer)] = '\0';
        tcsetattr(terminal, TCSAFLUSH, &before);
    }
    close(terminal);
    return strstr(answer, "_Gi=31;OK") ? WATCH_KITTY : has_sixel(answer) ? WATCH_SIXEL : WATCH_BLOCKS;
}

// Returns whether the terminal has colours, by its terminfo name. DEC's terminals ("vt100" and similar) have none,
// except for VT525 and VT241. Terminals whose name ends in "-m" have none, either.
static bool has_colors(void)
{
    const char *term = getenv("TERM");
    size_t length = term ? strlen(term) : 0;
    if (length > 2 && strcmp(term + length - 2, "-m") == 0)
        return false;
    bool is_vt = length > 3 && strncmp(term, "vt", 2) == 0 && term[2] >= '0' && term[2] <= '9';
    return !is_vt || strncmp(term, "vt525", 5) == 0 || strncmp(term, "vt241", 5) == 0;
}

void watch_terminal_open(watch_terminal *terminal, const char *name, bool color)
{
    static const char *const names[] = { "text", "blocks", "sixel", "kitty" };
    const char *depth = getenv("COLORTERM");
    *terminal = (watch_terminal) { .color = color, .is_fresh = true };
    terminal->full_color = depth && (strcmp(depth, "truecolor") == 0 || strcmp(depth, "24bit") == 0);
    for (int i = 0; i < 4 && name; i++)
        if (strcmp(name, names[i]) == 0)
            terminal->graphics = (watch_graphics)i;
    if (!name && color)
        terminal->graphics = find_graphics();
    if (!name && terminal->graphics == WATCH_BLOCKS && !has_colors())
        terminal->graphics = WATCH_TEXT;
}

void watch_terminal_close(watch_terminal *terminal)
{
    if (terminal->graphics != WATCH_TEXT && !terminal->is_fresh)
        fputs("\033[0m\n", stderr);
}

// ---- Sizes ----

typedef struct place { ///< space for the picture
    int columns, rows; ///< in characters
    int width, height; ///< in pixels; 0: unknown
} place;

static place find_place(void)
{
    struct winsize size = { 0 };
    place p = { 80, 24, 0, 0 };
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0)
        p = (place) { size.ws_col, size.ws_row, size.ws_xpixel, size.ws_ypixel };
    p.height = p.height / p.rows * (p.rows > 3 ? p.rows - 2 : 1);
    p.rows = p.rows > 3 ? p.rows - 2 : 1; // leaves space for the line below
    return p;
}

// Computes the largest size with the picture's aspect ratio that fits the limits, and is not larger than the picture.
static void fit(const watch_picture *picture, int max_width, int max_height, int *width, int *height)
{
    double w = picture->width, h = picture->height;
    double scale = max_width / w < max_height / h ? max_width / w : max_height / h;
    scale = scale < 1 ? scale : 1;
    *width = w * scale >= 1 ? (int)(w * scale) : 1;
    *height = h * scale >= 1 ? (int)(h * scale) : 1;
}

// ---- Half blocks: a character is two pixels, the upper in the letter's colour ----

static int cube_color(const unsigned char *rgb)
{
    return 16 + 36 * ((rgb[0] * 5 + 127) / 255) + 6 * ((rgb[1] * 5 + 127) / 255) + (rgb[2] * 5 + 127) / 255;
}

static void put_color(const watch_terminal *terminal, int layer, const unsigned char *rgb)
{
    if (terminal->full_color)
        fprintf(stderr, "\033[%d;2;%d;%d;%dm", layer, rgb[0], rgb[1], rgb[2]);
    else
        fprintf(stderr, "\033[%d;5;%dm", layer, cube_color(rgb));
}

static void draw_blocks(const watch_terminal *terminal, const watch_picture *picture)
{
    place p = find_place();
    watch_small small;
    int width, height;
    fit(picture, p.columns, 2 * p.rows, &width, &height);
    height += height % 2;
    if (!watch_small_create(picture, width, height, &small))
        return;
    for (int y = 0; y < height; y += 2) {
        const unsigned char *upper = small.rgb + (size_t)y * (size_t)width * 3, *lower = upper + (size_t)width * 3;
        for (int x = 0; x < width; x++) {
            put_color(terminal, 38, upper + 3 * x);
            put_color(terminal, 48, lower + 3 * x);
            fputs("\xe2\x96\x80", stderr); // U+2580, upper half block
        }
        fputs("\033[0m\033[K\n", stderr);
    }
    free(small.rgb);
}

// ---- Sixels ----

static void draw_sixels(const watch_picture *picture)
{
    place p = find_place();
    watch_small small;
    int width, height;
    fit(picture, p.width ? p.width : 640, p.height ? p.height : 360, &width, &height);
    if (!watch_small_create(picture, width, height, &small))
        return;
    watch_sixels_put(&small);
    free(small.rgb);
}

// ---- The kitty graphics protocol: the PNG file itself, in base 64 ----

static void draw_kitty(const watch_picture *picture)
{
    enum { CHUNK = 3072 }; // bytes; their 4096 base64 digits are the protocol's limit
    char digits[CHUNK / 3 * 4];
    place p = find_place();
    int cell_width = p.width > 0 ? p.width / p.columns : 8, cell_height = p.height > 0 ? p.height / p.rows : 16;
    int width, height;
    cell_width = cell_width > 0 ? cell_width : 8;
    cell_height = cell_height > 0 ? cell_height : 16;
    fit(picture, p.columns * cell_width, p.rows * cell_height, &width, &height);
    int columns = width / cell_width, rows = height / cell_height;
    fputs("\033_Ga=d,d=A,q=2\033\\", stderr); // deletes the previous picture
    for (size_t at = 0; at < picture->size; at += CHUNK) {
        size_t left = picture->size - at, size = left < CHUNK ? left : CHUNK;
        if (at == 0)
            fprintf(stderr, "\033_Ga=T,f=100,q=2,c=%d,r=%d,m=%d;", columns > 0 ? columns : 1, rows > 0 ? rows : 1,
                    left > size);
        else
            fprintf(stderr, "\033_Gm=%d;", left > size);
        fwrite(digits, 1, glintL_base64(picture->bytes + at, size, digits), stderr);
        fputs("\033\\", stderr);
    }
    fputc('\n', stderr);
}

// ---- Drawing ----

static void begin(watch_terminal *terminal)
{
    fputs(terminal->is_fresh ? "\033[2J\033[H" : "\033[H", stderr);
    terminal->is_fresh = false;
}

void watch_terminal_draw(watch_terminal *terminal, const watch_picture *picture, const char *line)
{
    static char buffer[1 << 16]; // so that a picture takes few writes
    if (terminal->graphics != WATCH_TEXT) {
        setvbuf(stderr, buffer, _IOFBF, sizeof buffer);
        begin(terminal);
        if (terminal->graphics == WATCH_KITTY)
            draw_kitty(picture);
        else if (terminal->graphics == WATCH_SIXEL)
            draw_sixels(picture);
        else
            draw_blocks(terminal, picture);
        fputs("\033[0m", stderr);
        glintL_put_text(stderr, line, strlen(line));
        fputs("\033[J", stderr);
        fflush(stderr);
        setvbuf(stderr, NULL, _IONBF, 0);
    } else {
        glintL_put_text(stderr, line, strlen(line));
        fputc('\n', stderr);
    }
}

void watch_terminal_error(watch_terminal *terminal, const char *message)
{
    if (terminal->graphics != WATCH_TEXT) // the message replaces the picture, from its top
        begin(terminal);
    fprintf(stderr, "%sglint: %serror:%s ", terminal->graphics != WATCH_TEXT ? "\033[K" : "",
            terminal->color ? "\033[1;31m" : "", terminal->color ? "\033[0m" : "");
    glintL_put_text(stderr, message, strlen(message));
    fputs(terminal->graphics != WATCH_TEXT ? "\033[K\n" : "\n", stderr);
}
