/// Compile-time switches for parts of the kernels. `make bench-effects` leaves out one part per build
/// (-DGLINT_WITHOUT_MESH=0,0) to check that the part costs nothing in scenes that do not need it. All other builds have
/// all parts. Three places leave out a part: the table of kernels (simd/table.c), the code that distinguishes kinds,
/// and the code that tests GLINT_WITH(part). In a build without an effect (WITHOUT=raster), only the table leaves out the
/// effect's kernels.
#ifndef GLINT_WITH_H
#define GLINT_WITH_H

/// 1 if the build has the part, 0 if GLINT_WITHOUT_part is defined as 0,0: then its second 0 replaces the 1.
#define GLINT_WITH(part) GLINT_WITH_SECOND(GLINT_WITHOUT_##part, 1, 0)
#define GLINT_WITH_SECOND(...) GLINT_WITH_SECOND_(__VA_ARGS__)
#define GLINT_WITH_SECOND_(first, second, ...) second

/// Returns the number of a kind. If the kind is left out, the number does not fit into a 16-bit field, so that no
/// test for it is compiled.
#define GLINT_KIND(with, number) ((with) ? (number) : 0x10000 + (number))

#endif
