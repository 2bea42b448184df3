/// Compile-time switches for parts of the kernels. `make bench-effects` leaves out one part per build
/// (-DGLINT_WITH_MESH=0) to check that the part costs nothing in scenes that do not need it. All other builds have
/// all parts. Three places leave out a part: the table of kernels (simd/table.c), the code that distinguishes kinds,
/// and the code that tests a name below. In a build without an effect (WITHOUT=raster), only the table leaves out the
/// effect's kernels.
#ifndef GLINT_WITH_H
#define GLINT_WITH_H

#ifndef GLINT_WITH_MESH
#define GLINT_WITH_MESH 1
#endif
#ifndef GLINT_WITH_SOLID
#define GLINT_WITH_SOLID 1
#endif
#ifndef GLINT_WITH_COMBINED
#define GLINT_WITH_COMBINED 1
#endif
#ifndef GLINT_WITH_RASTER
#define GLINT_WITH_RASTER 1
#endif
#ifndef GLINT_WITH_VERTEX_SHADING
#define GLINT_WITH_VERTEX_SHADING 1
#endif
#ifndef GLINT_WITH_BOUNCE
#define GLINT_WITH_BOUNCE 1
#endif
#ifndef GLINT_WITH_INDIRECT
#define GLINT_WITH_INDIRECT 1
#endif
#ifndef GLINT_WITH_ROUGH
#define GLINT_WITH_ROUGH 1
#endif
#ifndef GLINT_WITH_MICROFACET
#define GLINT_WITH_MICROFACET 1
#endif
#ifndef GLINT_WITH_BLINN
#define GLINT_WITH_BLINN 1
#endif
#ifndef GLINT_WITH_SPOT
#define GLINT_WITH_SPOT 1
#endif
#ifndef GLINT_WITH_AREA
#define GLINT_WITH_AREA 1
#endif
#ifndef GLINT_WITH_CAPS
#define GLINT_WITH_CAPS 1
#endif
#ifndef GLINT_WITH_SHADOW
#define GLINT_WITH_SHADOW 1
#endif
#ifndef GLINT_WITH_PROGRAM
#define GLINT_WITH_PROGRAM 1
#endif
#ifndef GLINT_WITH_DERIVATIVE
#define GLINT_WITH_DERIVATIVE 1
#endif
#ifndef GLINT_WITH_LENS
#define GLINT_WITH_LENS 1
#endif
#ifndef GLINT_WITH_SAMPLES
#define GLINT_WITH_SAMPLES 1
#endif

/// Returns the number of a kind. If the kind is left out, the number does not fit into a 16-bit field, so that no
/// test for it is compiled.
#define GLINT_KIND(with, number) ((with) ? (number) : 0x10000 + (number))

#endif
