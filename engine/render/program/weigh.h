/// Programs multiplied by a share, for the light of translucent surfaces. Internal.
#ifndef GLINT_PROGRAM_WEIGH_H
#define GLINT_PROGRAM_WEIGH_H

#include "engine/render/program/program.h"

/// A share, 0 .. 1. A program's values are clamped to that range; NaN counts as 0.
typedef struct glint_share {
    const glint_program *program; ///< a pattern with one output; NULL: `number` is the share
    double number;
} glint_share;

/// Makes a pattern of 1 - share.
glint_status glint_share_rest(const glint_share *share, glint_program **out, glint_error *error);
/// Makes a pattern of a colour times the share, with one output if the colour is grey.
glint_status glint_share_color(const glint_share *share, const double color[3], glint_program **out,
                               glint_error *error);
/// Makes a program of the outputs of `program` times the share. The diffuse and specular reflectance that a shader
/// reads are already multiplied by the share, so they are divided by it.
glint_status glint_share_program(const glint_share *share, const glint_program *program, glint_program **out,
                                 glint_error *error);

#endif
