/// codes FILE.png: prints the pixel values of an 8-bit RGB PNG as stored, on stdout: "WIDTH HEIGHT\n", then three
/// bytes per pixel, top row first.
#include <png.h>
#include <stdio.h>
#include <stdlib.h>

static int fail(const char *path, const char *what)
{
    fprintf(stderr, "codes: %s: %s\n", path, what);
    return 2;
}

int main(int argc, char **argv)
{
    const char *path = argc == 2 ? argv[1] : "";
    FILE *file = fopen(path, "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!file || !info || setjmp(png_jmpbuf(png)))
        return fail(path, file ? "cannot be read" : "cannot be opened");
    png_init_io(png, file);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    if (png_get_bit_depth(png, info) != 8 || png_get_color_type(png, info) != PNG_COLOR_TYPE_RGB)
        return fail(path, "8-bit RGB expected");
    const png_uint_32 width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    printf("%u %u\n", (unsigned)width, (unsigned)height);
    for (png_uint_32 y = 0; y < height; y++)
        fwrite(png_get_rows(png, info)[y], 3, width, stdout);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
    return fflush(stdout) ? 2 : 0;
}
