/// How different two pictures look to a person who flips between them: the LDR-FLIP of P. Andersson, J. Nilsson, T.
/// Akenine-Moller, M. Oskarsson, K. Astrom, M. D. Fairchild: "FLIP: A Difference Evaluator for Alternating Images",
/// Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020. Internal.
///
/// Colour: the pictures are blurred as the eye blurs them at a distance (contrast sensitivity, in YCxCz) and compared
/// in CIELAB with Hunt's adjustment by the HyAB distance, which is mapped to 0 .. 1. Features: edges and points of the
/// lightness that only one picture has increase the result: dE = dEc^(1 - dEf).
#ifndef GLINT_IMAGE_FLIP_H
#define GLINT_IMAGE_FLIP_H

#include "engine/glint_types.h"

/// The viewing conditions and constants of the paper.
#define GLINT_FLIP_PPD 67.02064327658226 ///< pixels per degree: 3840 pixels over 0.7 m, seen from 0.7 m: 3840 pi/180
#define GLINT_FLIP_QC 0.7 ///< exponent of the colour difference
#define GLINT_FLIP_PC 0.4 ///< share of the largest colour difference that is mapped to 0 .. GLINT_FLIP_PT
#define GLINT_FLIP_PT 0.95 ///< end of that range; larger colour differences are mapped to GLINT_FLIP_PT .. 1
#define GLINT_FLIP_W 0.082 ///< width of the feature detectors, degrees
#define GLINT_FLIP_QF 0.5 ///< exponent of the feature difference

/// A picture filtered as the eye sees it, ready to be compared.
typedef struct glint_flip glint_flip;

/// rgb  three planes of width * height values of linear light with sRGB primaries, 0 .. 1; read only.
glint_status glint_flip_create(int width, int height, const float *const rgb[3], glint_flip **out, glint_error *error);
void glint_flip_destroy(glint_flip *flip);

/// Returns the mean difference of two pictures of the same size, 0 (identical) .. 1. Symmetric.
double glint_flip_mean(const glint_flip *a, const glint_flip *b);

#endif
