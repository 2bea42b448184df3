/// What is drawn over a picture, or around pictures: labels, arrows, formulas, charts, colour bars and contact sheets.
#ifndef GLINT_FIGURES_H
#define GLINT_FIGURES_H

#include "glint_types.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

// ---- Overlays ------------------------------------------------------------------------------------------------------

/// The kind of an overlay. It determines which fields of the description are used.
typedef enum glint_overlay_kind {
    GLINT_OVERLAY_LABEL, ///< `text`
    GLINT_OVERLAY_COLORBAR, ///< the colours of a map with numbers next to them; `text` is its title
    GLINT_OVERLAY_AXES, ///< the world's x, y and z directions as the camera sees them, each with its name. With a
        ///< `box`: three of its edges as the camera sees them, with numbers along them
    GLINT_OVERLAY_ARROW, ///< a line between two points of the world, with a head at `to`; `text` is its label
    GLINT_OVERLAY_LINE, ///< the same as an arrow, but without a head; its label is next to its middle
    GLINT_OVERLAY_ARC, ///< the angle between the directions `from` and `to` at `point`; `text` is its label
    GLINT_OVERLAY_POLYLINE, ///< straight segments between `points`; `text` is its label, next to its middle
    // Polylines whose points the caller computes before a plan is made, from the fields that their comments name:
    GLINT_OVERLAY_LOBE, ///< the polar diagram of a highlight at `point`; see glint_material_evaluate
    GLINT_OVERLAY_PATH, ///< the path of a ray; see glint_scene_path
    GLINT_OVERLAY_FRUSTUM, ///< the view of a camera; see glint_camera_point
    GLINT_OVERLAY_CHART ///< curves over a grid, with numbers and names along two axes; `text` is its title
} glint_overlay_kind;

#define GLINT_OVERLAY_POINTS_MAX 128 ///< most points of a polyline
#define GLINT_POINT_BEGINS 1u ///< bits of point_flags: no segment leads to this point
#define GLINT_POINT_MARKED 2u ///< a dot is drawn at the point

/// How an arrow, a line, an arc or a label at a point is drawn where surfaces hide it.
/// Surfaces count at any opacity.
typedef enum glint_hidden {
    GLINT_HIDDEN_DRAWN, ///< the same as in front of surfaces
    GLINT_HIDDEN_DASHED, ///< dashes; not for labels
    GLINT_HIDDEN_NONE ///< nothing; an arrow has no head and no label if its tip is hidden, and a line or an arc no
        ///< label if its middle is hidden
} glint_hidden;

/// A table of 256 colours, from the lowest value to the highest.
typedef enum glint_colormap {
    GLINT_COLORMAP_VIRIDIS, ///< N. Smith and S. van der Walt, 2015
    GLINT_COLORMAP_MAGMA, ///< N. Smith and S. van der Walt, 2015
    GLINT_COLORMAP_CIVIDIS, ///< J. R. Nunez, C. R. Anderton and R. S. Renslow, 2018
    GLINT_COLORMAP_TURBO, ///< A. Mikhailov, 2019
    GLINT_COLORMAP_COOLWARM, ///< K. Moreland, 2009
    GLINT_COLORMAP_COUNT ///< number of colour maps
} glint_colormap;

/// Returns "viridis", ...; NULL if out of range.
const char *glint_colormap_name(glint_colormap map);
/// Returns the 256 colours of a map as 8-bit sRGB 0xRRGGBB; static. NULL if out of range.
const uint32_t *glint_colormap_table(glint_colormap map);

/// The direction of a colour bar: from bottom to top, or from left to right.
typedef enum glint_orientation { GLINT_ORIENTATION_VERTICAL, GLINT_ORIENTATION_HORIZONTAL } glint_orientation;

#define GLINT_CURVES_MAX 16 ///< most curves of a chart
#define GLINT_CHART_TEXT_SIZE 128 ///< bytes of the label of a curve or the name of an axis, with the ending NUL

/// A curve of a chart: straight lines from point to point. Pointers are borrowed for the call.
typedef struct glint_curve {
    const double *x, *y; ///< finite. Where one of them is NaN, the line has a gap; at least one point is not a gap
    size_t count; ///< number of points, 1 .. 1000000
    const char *label; ///< UTF-8, one line, next to the end of the curve; "": none
    bool has_color; ///< false: a colour for the curve's number
    double color[3]; ///< linear RGB, finite, >= 0
    bool has_width; ///< false: about a seventh of the letters' size
    double width; ///< thickness, points, 0 .. 1000; 0: no line; otherwise at least a pixel
    bool has_dots; ///< true: a dot at each point. A point between two gaps always has one
} glint_curve;

/// The curves of a chart. Immutable, reference counted; any thread.
typedef struct glint_chart glint_chart;
/// Makes a chart from a copy of 1 .. GLINT_CURVES_MAX curves. GLINT_ERR_INVALID names the curve and its field.
glint_status glint_chart_create(const glint_curve *curves, size_t count, glint_chart **out, glint_error *error);
/// Takes another reference; returns its argument.
glint_chart *glint_chart_retain(glint_chart *chart);
/// Releases a reference; the last one frees the chart. NULL: nothing.
void glint_chart_release(glint_chart *chart);
/// Returns curve number `i`, from 0, whose pointers are valid as long as the chart; NULL: there is none.
const glint_curve *glint_chart_curve(const glint_chart *chart, size_t i);

#define GLINT_OVERLAY_TEXT_SIZE 384 ///< bytes of an overlay's text, with the ending NUL
#define GLINT_OVERLAY_TICKS_MAX 16 ///< most numbers next to a colour bar
#define GLINT_AXIS_NAME_SIZE 64 ///< bytes of an axis's name, with the ending NUL

/// The fields of an overlay. Each kind reads the fields whose comment names it, and those whose comment names no
/// kind.
typedef struct glint_overlay_desc {
    size_t struct_size; ///< sizeof(glint_overlay_desc)
    glint_overlay_kind kind; ///< kind of the overlay; glint_overlay_set cannot change it
    /// All kinds except axes: UTF-8, lines separated by newlines; "": none. Parts between two $ are formulas. Without a
    /// position, a label's lines that are wider than the picture are broken at blanks
    char text[GLINT_OVERLAY_TEXT_SIZE];
    /// Position as a fraction of the free space inside the margin: 0 is left or top, 1 right or bottom. Default:
    /// label {0, 0}, colour bar {1, 0.5}, axes {0, 1}, chart {0.5, 0.5}
    double at[2];
    bool has_position; ///< true: `position` is used instead of `at`
    /// Upper left corner, in pixels from the picture's upper left corner; finite, may lie outside
    double position[2];
    bool has_size; ///< false: a 36th of the picture's height in pixels, at least 10
    double size; ///< size of the letters, points, 1 .. 10000
    bool has_margin; ///< false: half of `size`
    /// Distance to the picture's border; for a label at a point of the world, distance to that point; points,
    /// 0 .. 10000
    double margin;
    /// Colour of letters and lines, linear RGB, finite, >= 0; above 1 counts as 1; default 1, chart 0.02. Not tone-mapped
    double color[3];
    bool has_background; ///< false: no rectangle is drawn behind the overlay; default false, chart true
    double background[3]; ///< colour of the rectangle behind the overlay; linear RGB like `color`; chart: default 1
    double opacity; ///< opacity of the rectangle, 0 .. 1; default 1
    bool has_length; ///< false: colour bar 10 times `size`, axes 2.5 times
    /// Colour bar: length of the bar; axes: length of an axis parallel to the picture; points, 1 .. 10000
    double length;
    glint_colormap map; ///< colour bar
    bool has_colors; ///< true: the colour bar shows `colors` instead of `map`
    uint32_t colors[256]; ///< from low to high, 8-bit sRGB 0xRRGGBB
    double low, high; ///< colour bar: the values at its ends; finite, different from each other; default 0, 1
    bool is_log; ///< colour bar: logarithmic scale; low and high are above 0
    glint_orientation orientation; ///< colour bar; default vertical
    double ticks[GLINT_OVERLAY_TICKS_MAX]; ///< colour bar: the values labelled, from low to high
    size_t tick_count; ///< number of `ticks`; 0: about five round values
    char names[3][GLINT_AXIS_NAME_SIZE]; ///< axes: names of x, y and z
    /// Axes. true: along edges of `box` that bound the visible part of it, instead of `at`; the upright axis is at
    /// the left, the others below. A direction that the eye looks along has no such edge and no axis; from inside the
    /// box there are none. Then has_position, has_margin, has_length and has_background must be false
    bool has_box;
    /// Lowest and highest corner in the world; finite; one or two sides may be 0 and then have no axis
    double box[2][3];
    /// With has_box: the box is an oblique cell at box[0] with the edge vectors `sides`; box[1] is not read
    bool has_sides;
    double sides[3][3]; ///< finite; one may be 0 and then has no axis, the others span a plane
    bool has_values; ///< false: axes show world coordinates, or for a cell lengths along its sides
    double values[2][3]; ///< values at the two corners; finite, different along each side that is not 0; may decrease
    /// Arrow, line: the two ends in the world, a finite distance apart; where they are equal, nothing is drawn. Arc:
    /// two directions, not zero, need not be unit; opposite ones have a half circle that faces the camera. Default
    /// {0, 0, 0}, {1, 0, 0}; arc {1, 0, 0}, {0, 1, 0}
    double from[3], to[3];
    bool has_point; ///< label. true: next to `point`, instead of `at` and `position`
    /// Label, arc: a point in the world. The text of a label, an arrow, a line or an arc tries eight positions around
    /// its place, and takes the first inside the picture that covers no other text, bar or axes and if possible no
    /// arrow, line or arc. If none is free it tries eight more, farther away, up to 11 times; if still none is free,
    /// it takes the first position of all
    double point[3];
    /// Polyline, lobe, path, frustum: points of the world, finite; flags of each point; their number: 2 .. 128 for a
    /// polyline, 0 .. 128 for the others
    double points[GLINT_OVERLAY_POINTS_MAX][3];
    uint8_t point_flags[GLINT_OVERLAY_POINTS_MAX];
    size_t point_count;
    /// Lobe: `from` is the normal (has_normal false: the surface's at `point`), `to` the direction to the light. Path:
    /// origin and direction of the ray. Both directions need not be unit
    bool has_normal;
    int64_t depth; ///< path: most surfaces at which the ray goes on, 0 .. 63; default 4
    double aspect; ///< frustum: width of the picture divided by its height, > 0; default 16 / 9
    bool has_radius; ///< arc. false: the radius is a twelfth of the picture's height at the distance of `point`
    /// Arc: its radius. Lobe: length of a highlight of 1; without has_radius 1. Path: length of a segment that hits
    /// nothing; without has_radius the length of the first segment. Frustum: distance of the picture from the eye;
    /// without has_radius the distance of the point that the camera looks at, or 1. World units, > 0
    double radius;
    bool has_width; ///< overlays with lines. false: the width is an eighth of `size`
    double width; ///< thickness of a line, points, 0 .. 10000; at least one pixel is drawn
    /// Overlays with lines: how the hidden part is drawn; label at `point`: what is drawn if the point is hidden, not
    /// dashes; default drawn
    glint_hidden hidden;
    glint_chart *chart; ///< chart: its curves; retained, not NULL
    char titles[2][GLINT_CHART_TEXT_SIZE]; ///< chart: names of x and y; "": none
    bool is_log_axis[2]; ///< chart: logarithmic x, y; all their numbers are above 0
    bool has_range[2]; ///< chart. false: the range of the points, for y with a little space
    double range[2][2]; ///< chart: first and last number along x and y; finite, different
    bool has_extent; ///< chart. false: the picture inside the margin
    double extent[2]; ///< chart: width and height with numbers and names, points, 1 .. 10000
    char name[GLINT_NAME_SIZE]; ///< name for messages; "": none
} glint_overlay_desc;

/// Writes a description with every field at the default for this kind.
void glint_overlay_desc_init(glint_overlay_desc *desc, size_t size, glint_overlay_kind kind);
GLINT_DESC_DEFAULT_OF(overlay);
/// Makes an overlay from a copy of `desc`. Texts run from left to right: letters of right-to-left scripts are an
/// error. GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_overlay_create(const glint_overlay_desc *desc, glint_overlay **out, glint_error *error);
/// Replaces the description by a copy of the same kind; on error nothing changes.
glint_status glint_overlay_set(glint_overlay *overlay, const glint_overlay_desc *desc, glint_error *error);
/// Returns the description; borrowed, valid until the overlay is set or released.
const glint_overlay_desc *glint_overlay_get(const glint_overlay *overlay);

/// Lists the commands of formulas, for programs that set formulas themselves. Returns the name of command number `index`
/// without its backslash, such as "alpha"; NULL beyond the last one.
///   text   its sign, UTF-8; static
///   kind   "variable", set slanted; "large", a large operator; or the class of TeX's atom: "ordinary", "operator",
///          "binary", "relation", "opening", "closing", "punctuation", "inner"
const char *glint_formula_command(size_t index, const char **text, const char **kind);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
