/// A closed mesh, convex except for the rounding of its corners, and rays at its seams.
#ifndef HARD_SHELL_H
#define HARD_SHELL_H

#include "tests/hard/oracle/drive.h"

#define SIDE 4 ///< number of quads along an edge of the box
#define VERTICES (6 * (SIDE + 1) * (SIDE + 1))
#define QUADS (6 * SIDE * SIDE)

typedef struct shell {
    double vertex[VERTICES][3];
    uint32_t corner[QUADS][4], size[QUADS];
    double middle[3];
} shell;

/// Makes a box or ball of quads that need not be planar, at any position.
/// The two sides of a seam have identical coordinates.
void make_shell(shell *s, bool ball, double size, double away);
void add_shell(glint_scene *scene, const shell *s, glint_material *material);

/// Aims a ray from inside at a corner, at a point on an edge or diagonal, or next to one of these.
hard_ray aim_at_seam(const shell *s, double size);

#endif
