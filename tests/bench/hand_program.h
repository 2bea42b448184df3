/// Programs written by hand.
#ifndef GLINT_BENCH_HAND_PROGRAM_H
#define GLINT_BENCH_HAND_PROGRAM_H

/// Prints nanoseconds per point of Phong's shader.
void hand_run_program(void);

#endif
