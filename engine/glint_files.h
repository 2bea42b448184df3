/// Pictures and meshes, to and from files.
#ifndef GLINT_FILES_H
#define GLINT_FILES_H

#include "glint.h"
#include "glint_figures.h"
#include "glint_programs.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

// ---- Pictures to files ---------------------------------------------------------------------------------------------

/// How PNG data are compressed: quickly, or into fewer bytes.
typedef enum glint_encode { GLINT_ENCODE_FAST, GLINT_ENCODE_SMALL } glint_encode;

/// Returns the name and version of the deflate library behind a setting in this build: "isal 2.30.0".
const char *glint_encoder_name(glint_encode encode);

/// A text chunk of a PNG. Both strings are borrowed.
typedef struct glint_text {
    const char *keyword; ///< PNG tEXt keyword: 1 .. 79 Latin-1 characters
    const char *value; ///< any length up to 64 KiB; bytes outside Latin-1 are written as '?'
} glint_text;

/// One pass as a file. Pointers are borrowed for the call.
typedef struct glint_write_desc {
    size_t struct_size; ///< sizeof(glint_write_desc)
    /// Ends in .png; in .svg or .pdf for a bitmap with overlays and text as vectors, on a page of 72 / dpi points per
    /// pixel; in .pfm or .npy for the linear float32 of one pass (.npy: NumPy, height x width or height x
    /// width x 3, top row first); or in .exr for all passes of the image, as channels of one file: R, G, B, A,
    /// depth.Z, normal.X ... diffuse.B
    const char *path;
    glint_pass pass; ///< a pass of the image; ignored by .exr, which has all
    /// .png; depth, normal, object_id and derivatives are scaled for viewing, see bindings/README.md. .exr: with 16 `bits`, light
    /// and normals are half floats; with 8, they are float. Everything else is always float. .svg: like .png; .pdf:
    /// 8-bit sRGB values only
    glint_tone_desc tone;
    glint_encode encode; ///< .png; default GLINT_ENCODE_FAST
    double dpi; ///< .png, .svg, .pdf: pixels per inch for printing, 0 .. 1e6; 0: not set
    /// .png of depth and derivatives: 1 + a glint_colormap, whose colours replace grey; 0: grey. For depth, the
    /// background stays black; for a derivative, the mean of its three components is shown
    int colormap;
    /// .png of depth and derivatives: the values at the ends of the grey scale or colour map, which is linear;
    /// finite. Equal (default): the picture's own range, see bindings/README.md
    double range[2];
    const glint_text *text; ///< .png and .exr
    size_t text_count; ///< 0: no texts
} glint_write_desc;

/// Returns "OpenEXR 3.1.5"; NULL: this build cannot write .exr.
const char *glint_exr_library(void);
/// Returns the version of cairo, "1.16.0"; NULL: this build cannot write .pdf.
const char *glint_cairo_version(void);
/// Returns the names and versions of the libraries in use; the last entry is NULL. Static strings.
const char *const *glint_libraries(void);

/// Writes one pass to a file that appears complete or not at all: a temporary name in the same folder, fsync, rename.
/// An existing file that is not a regular one (a pipe, /dev/full) is written in place. Missing folders are created.
/// GLINT_ERR_NO_SPACE for ENOSPC and EDQUOT, GLINT_ERR_IO otherwise; the message names the file.
glint_status glint_image_write(const glint_image *image, const glint_write_desc *desc, glint_error *error);

/// Returns the bytes that glint_image_write would write; the ending of `desc->path` gives the format. The caller
/// frees *data with free().
glint_status glint_image_to_bytes(const glint_image *image, const glint_write_desc *desc, uint8_t **data, size_t *size,
                                  glint_error *error);

/// Fills `out`, 4 x width x height bytes, with the 8-bit values of one pass as a .png would hold them: RGBA, top row
/// first, alpha 255 where the picture has none. Reads from `desc` the pass, the tone (8 bits), dpi and colormap.
glint_status glint_image_rgba(const glint_image *image, const glint_write_desc *desc, uint8_t *out, glint_error *error);

/// Returns the picture without its overlays, whose pixels it shares; the image itself if it has none. Borrowed.
const glint_image *glint_image_without_overlays(const glint_image *image);

/// A page that shows a picture at another size than its own.
typedef struct glint_page {
    int width, height; ///< size of the picture on the page, pixels of the page; 1 .. GLINT_SIDE_MAX
    /// pixels of the page per pixel of the picture for which the script gives positions, > 0. Sizes in points, at the
    /// picture's dpi, are scaled by it
    double scale;
    double dpi; ///< of the script's picture; 0: 72
    double least; ///< smallest size of letters, pixels of the page, 0 .. 1000
    glint_transfer transfer; ///< of the picture's values
} glint_page;

/// Returns the overlays of a picture as an SVG element for a page, with text in `text` elements. The parts of curves
/// that surfaces hide are those found for the picture. The caller frees *svg; NULL: the picture has no overlays.
glint_status glint_image_overlays_svg(const glint_image *image, const glint_page *page, char **svg, glint_error *error);

/// Writes the key of a finished frame: 32 hex digits, a hash of the engine version, all data that the plan reads, the
/// encoder version, and the fields tone, encode and pass of `desc`. Threads, instruction set, shard and path are not
/// included.
void glint_frame_key(const glint_plan *plan, const glint_write_desc *desc, char key[33]);
/// Writes the key of the whole frame that a region belongs to; without a region, the frame's own key.
void glint_whole_key(const glint_plan *plan, const glint_write_desc *desc, char key[33]);

/// Returns whether `path` is a complete PNG (every CRC right, IEND at the end) whose tEXt "glint:key" equals key.
bool glint_file_has_key(const char *path, const char *key);

/// Writes images on its own threads, in the order submitted, so that rendering, encoding and disk writes overlap. The
/// writer keeps the last picture in compressed form, about as large as its file, so that unchanged parts are not
/// compressed again.
typedef struct glint_writer glint_writer;

/// The result of one submitted file.
typedef struct glint_write_result {
    glint_status status; ///< GLINT_OK: the file is complete
    char message[512]; ///< "" on success; otherwise the file and the reason
    double encode_ms; ///< time from pixel values to bytes
    double write_ms; ///< time from bytes to a synced, renamed file
    double reused; ///< share of the compressed bytes that were taken from the previous file, band of rows by band of
        ///< rows, 0 .. 1
    void *user; ///< the pointer submitted with the image
} glint_write_result;

/// Makes a writer.
///
/// queue_depth  number of images that may wait, >= 1; a further submit blocks. Above 2, a renderer that is faster than
///              the encoder finds no finished pictures whose memory it could reuse.
/// threads      number of threads that encode one image together, 1 .. 1024; 0: one per processor; 1: only the
///              writer's own thread. The files do not depend on this number.
glint_status glint_writer_create(int queue_depth, int threads, glint_writer **out, glint_error *error);
/// Finishes the queue, then frees the writer. Results not collected are lost.
void glint_writer_destroy(glint_writer *writer);
/// Retains the image and copies `desc` with its strings. The result carries `user`.
glint_status glint_writer_submit(glint_writer *writer, glint_image *image, const glint_write_desc *desc, void *user,
                                 glint_error *error);
/// Takes the next result, in the order submitted; waits for it if `wait` is set. False: there is none.
bool glint_writer_collect(glint_writer *writer, bool wait, glint_write_result *result);
/// Drops queued files that are not started (their results have GLINT_ERR_CANCELLED); files already started are
/// finished.
void glint_writer_cancel(glint_writer *writer);

// ---- Files ---------------------------------------------------------------------------------------------------------

/// A file being written, under a hidden name in the same folder. At any time the final name holds a complete file or
/// none.
typedef struct glint_draft glint_draft;

/// Opens a draft for `path`. Missing folders are created; a symbolic link is followed. An existing file that is not a
/// regular file (a pipe, a device) is written in place and never replaced.
///
/// Messages of create, append and finish read "<path>: <reason>"; GLINT_ERR_NO_SPACE for ENOSPC and EDQUOT,
/// GLINT_ERR_NOMEM, GLINT_ERR_IO for the rest. A draft belongs to one thread at a time.
glint_status glint_draft_create(const char *path, glint_draft **out, glint_error *error);
/// Returns the hidden name, for another program to write to; owned by the draft.
const char *glint_draft_name(const glint_draft *draft);
glint_status glint_draft_append(glint_draft *draft, const void *bytes, size_t size, glint_error *error);
/// Syncs the file and renames it to its final name, replacing an older file. Only glint_draft_destroy may follow.
glint_status glint_draft_finish(glint_draft *draft, glint_error *error);
/// Removes an unfinished draft. NULL does nothing.
void glint_draft_destroy(glint_draft *draft);

/// Removes from a folder the hidden files of drafts whose process was killed: drafts of this host at once, drafts of
/// other hosts one day after their last write. A process does this once in each folder where it opens a draft or
/// calls glint_file_has_key. Any thread.
void glint_drafts_collect(const char *path);
/// Removes the hidden files of this process's drafts, for a signal handler that ends the process next. It is
/// async-signal-safe; no draft can be finished afterwards.
void glint_drafts_abandon(void);

/// A finished .png or .pfm, read back. Immutable.
typedef struct glint_picture glint_picture;

/// Reads `path`; an incomplete file is GLINT_ERR_FORMAT. Without `pixels`, reads only the size and the texts: CRCs
/// are checked, but nothing is decompressed. Messages name the file.
glint_status glint_picture_read(const char *path, bool pixels, glint_picture **out, glint_error *error);
/// Reads a .png, with its pixels, from bytes in memory, which may be freed after the call.
glint_status glint_picture_from_bytes(const void *data, size_t size, glint_picture **out, glint_error *error);
/// Frees the picture with its texts. NULL: nothing.
void glint_picture_destroy(glint_picture *picture);
/// Size in pixels.
int glint_picture_width(const glint_picture *picture);
int glint_picture_height(const glint_picture *picture);
int glint_picture_bits(const glint_picture *picture); ///< bits per channel, 8 or 16; 32 for a .pfm
int glint_picture_channels(const glint_picture *picture); ///< number of channels, 1 .. 4; with 2 and 4, the last
    ///< channel is alpha
/// Returns whether pixel values are sRGB or linear, by the gAMA and sRGB chunks; a .pfm is linear.
glint_transfer glint_picture_transfer(const glint_picture *picture);
/// Returns the value of a PNG's tEXt, as UTF-8; owned by the picture. NULL: there is none.
const char *glint_picture_text(const glint_picture *picture, const char *keyword);
/// Writes row `y`, from 0 at the top, as 3 * width 8-bit sRGB values for viewing. Grey becomes RGB, 16-bit and linear
/// values are rounded, and transparent pixels are blended over a grey of `backdrop`, 0 .. 255. Needs the pixels.
void glint_picture_row(const glint_picture *picture, int y, int backdrop, uint8_t *rgb);
/// Writes row `y` as 3 * width numbers of linear light. sRGB values are decoded, linear values are divided by the
/// largest possible value, grey becomes RGB, alpha is dropped. Needs the pixels.
void glint_picture_light(const glint_picture *picture, int y, float *rgb);

/// A finished part of a picture.
typedef struct glint_picture_part {
    const glint_picture *picture; ///< a .png with three or four channels, read with its pixels
    int x, y; ///< position of its top left pixel in the whole picture
} glint_picture_part;

/// Joins parts to a picture of width x height pixels and writes it as glint_image_write would have written the whole.
/// `desc` gives path (.png), transfer and bits of the tone, encode and text; its pass is ignored. Parts may overlap
/// if their pixels are equal. GLINT_ERR_INVALID: the message names, by its number from 1, a part that lies outside,
/// that differs from the first in bits or channels, or that disagrees with an earlier part; or the first pixel that
/// no part covers.
glint_status glint_picture_join(const glint_picture_part *parts, size_t count, int width, int height, const glint_write_desc *desc,
                               glint_error *error);

/// An animated PNG being written.
typedef struct glint_apng glint_apng;

/// The fields of an animated PNG.
typedef struct glint_apng_desc {
    int width, height; ///< 1 .. GLINT_SIDE_MAX
    int bits; ///< 8 or 16
    bool alpha; ///< frames are RGBA
    glint_transfer transfer; ///< encoding of the pixel values of all frames
    uint32_t frame_count; ///< 1 .. 2^30
    /// Frames per second, 1/65535 .. 65535; a frame's duration is the ratio of two 16-bit numbers nearest to 1/fps
    double fps;
    uint32_t plays; ///< 0: for ever
    glint_encode encode; ///< how frames are compressed
} glint_apng_desc;

/// Opens a draft for `path` and writes the header.
glint_status glint_apng_create(const char *path, const glint_apng_desc *desc, glint_apng **out, glint_error *error);
/// Adds a frame: RGB or RGBA, of the size, bits and transfer described. Only the part that changed is stored.
glint_status glint_apng_add(glint_apng *apng, const glint_picture *picture, glint_error *error);
/// Gives the file its name, after frame_count frames were added.
glint_status glint_apng_finish(glint_apng *apng, glint_error *error);
/// Frees the writer; an unfinished file is removed. NULL does nothing.
void glint_apng_destroy(glint_apng *apng);

// ---- Meshes from files ---------------------------------------------------------------------------------------------

/// Reads a mesh; `desc` gives the fields that are not in the file. GLINT_ERR_IO if it cannot be read,
/// GLINT_ERR_FORMAT if its contents are invalid: the message has "FILE:LINE: ...", or the number of the vertex or
/// face. The ending of the name selects the format:
///
/// .stl  text or binary; corners at the same position are one vertex. Normals in the file are ignored; faces have
///       their own.
/// .ply  text or binary, either byte order: vertices (x y z, nx ny nz, u v or s t), faces (texcoord) and tristrips.
///       If `desc` has no material, a comment TextureFile names the picture of the diffuse colour. Otherwise red,
///       green and blue (8-bit or 16-bit values, or floats 0 .. 1 or 0 .. 255; sRGB) give each face a material named
///       after its colour ("#ff8000"): the face's own colour, or the mean of its corners in linear light, rounded to
///       8 bits.
/// else  Wavefront .obj: v (x y z, and r g b as in .ply), vt, vn and f (any polygon; negative numbers count from the
///       end). If `desc` has no material, also usemtl and mtllib: Kd, Ks, Ns, d (or Tr), Pr and Pm (microfacets),
///       illum 3 .. 7 (mirror of Ks; 5, 7 fresnel; 6, 7 refraction by Ni), map_Kd, map_Ks, map_d (holes where red is
///       below one half), map_Bump (grey; -bm is its height). For other illum, d < 1 transmits without refraction,
///       and Kd and Ks are multiplied by d. Groups, lines and points are ignored.
///
/// Faces without area, with fewer than 3 corners or with vertices that are not finite are left out. Polygons that
/// intersect themselves are cut as fans. Normals of length 0, invalid lines of .mtl files and unknown statements are
/// ignored. `warns` is called once for each kind of problem.
glint_status glint_mesh_load(const char *path, const glint_mesh_desc *desc, glint_shape **out, glint_error *error);

// ---- Other strengths and colours of lights -------------------------------------------------------------------------

/// name of the light pass for the light in a file that none of its light passes contains
#define GLINT_LIGHT_OTHER "..."

/// Reads a scan-line .exr with light passes: channels R, G and B of the picture, light.NAME.R, .G and .B of each
/// pass, and A, if any. If the passes do not add up to the picture, beyond rounding, the rest becomes one more pass,
/// GLINT_LIGHT_OTHER. The image has no beauty plane, since the passes add up to it. GLINT_ERR_IO, GLINT_ERR_FORMAT
/// with the file's name; GLINT_ERR_UNSUPPORTED in a build without OpenEXR.
glint_status glint_lights_read(const char *path, glint_image **out, glint_error *error);
/// Makes a beauty picture in which light pass number i is multiplied by `factors[i]` in each channel; alpha is copied
/// if there is any. The sum is computed in double in the order of the passes and rounded to float32 once.
glint_status glint_image_relight(const glint_image *lights, const double (*factors)[3], glint_image **out, glint_error *error);

// ---- Textures ------------------------------------------------------------------------------------------------------

/// Reads a texture from a .png, .hdr or .pfm file, or from a .jpg or .exr file if the build has libjpeg or OpenEXR.
///
/// desc  `wrap`, `filter` and `linear`. Files that declare themselves linear (a .png with gAMA 1.0), .hdr, .exr and .pfm
///       always are.
///
/// GLINT_ERR_IO, GLINT_ERR_FORMAT if the file cannot be read or is not a complete picture; GLINT_ERR_NOMEM.
glint_status glint_texture_read(const char *path, const glint_texture_desc *desc, glint_texture **out, glint_error *error);

// ---- Contact sheets ------------------------------------------------------------------------------------------------

/// One picture of a contact sheet. Strings are borrowed.
typedef struct glint_sheet_cell {
    const char *path; ///< path of a .png or .pfm; all cells have pictures of the same size
    const char *label; ///< UTF-8, parts separated by newlines, which share a line if they fit; NULL: none
} glint_sheet_cell;

/// A contact sheet. Pointers are borrowed for the call.
typedef struct glint_sheet_desc {
    size_t struct_size; ///< sizeof(glint_sheet_desc)
    const glint_sheet_cell *cells; ///< row by row
    size_t cell_count; ///< >= 1
    int columns; ///< >= 1
    const char *title; ///< title of the sheet; NULL: none
    const char *across, *down; ///< names of the columns and of the rows, at most 1000 bytes each; NULL: none
    /// Heads: a text above each column, next to each row, and above each block of `block_rows` rows; NULL: none. The
    /// text above a column has parts like a label
    const char *const *column_heads, *const *row_heads, *const *block_heads;
    int block_rows; ///< >= 1 with `block_heads`
    /// Number of the cell, from 1, that each row is compared with in an extra row below it; 0: no such rows
    size_t difference;
    double gain; ///< factor applied to the differences; > 0
    /// Size of labels, in points of dpi / 72 pixels, 0 .. 10000; 0: 13 pixels, or 26 below pictures at least 900 wide
    double size;
    double dpi; ///< pixels per inch for printing, 0 .. 1e6; 0: not set, and a point is a pixel
    bool transparent; ///< the paper is transparent; pictures are drawn as on white
    /// A colour bar for all pictures, to their right, or below them if horizontal; NULL: none. It uses the fields of
    /// its kind, with `length` in points (default: as long as the pictures together, at most 20 times `size`), and
    /// the sheet's text size and ink
    const glint_overlay_desc *colorbar;
} glint_sheet_desc;

/// Draws finished pictures in rows, with labels, as one 8-bit .png, .svg or .pdf: dark text on white. If a picture is
/// missing or differs in size from the first, the error names it and the file is unchanged. A row of differences holds
/// `gain` times |cell - chosen cell|, in 8-bit sRGB values.
glint_status glint_sheet_write(const glint_sheet_desc *desc, const char *path, glint_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
