/// The names and versions of the libraries in use.
#include "engine/figures/text/letters.h"
#include "engine/files/picture/jpeg.h"
#include "engine/glint.h"

#include <png.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <xxhash.h>
#include <zlib.h>

#define LIBRARIES_MAX 12
#define NAME_SIZE 48

static char names[LIBRARIES_MAX][NAME_SIZE];
static const char *list[LIBRARIES_MAX + 1];

static void add(const char *name)
{
    int count = 0;
    while (list[count] && strcmp(list[count], name) != 0)
        count++;
    if (list[count] || count == LIBRARIES_MAX)
        return;
    snprintf(names[count], NAME_SIZE, "%s", name);
    list[count] = names[count];
}

static void make_list(void)
{
    char name[NAME_SIZE];
    const unsigned hash = XXH_versionNumber();
    snprintf(name, sizeof name, "libpng %s", png_get_libpng_ver(NULL));
    add(name);
    snprintf(name, sizeof name, "zlib %s", zlibVersion());
    add(name);
    add(glint_encoder_name(GLINT_ENCODE_FAST));
    add(glint_encoder_name(GLINT_ENCODE_SMALL));
    snprintf(name, sizeof name, "xxhash %u.%u.%u", hash / 10000, hash / 100 % 100, hash % 100);
    add(name);
    if (glint_exr_library())
        add(glint_exr_library());
    if (glint_jpeg_library())
        add(glint_jpeg_library());
    if (glint_letters_library())
        add(glint_letters_library());
    snprintf(name, sizeof name, "cairo %s", glint_cairo_version() ? glint_cairo_version() : "");
    if (glint_cairo_version())
        add(name);
}

const char *const *glint_libraries(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_list);
    return list;
}
