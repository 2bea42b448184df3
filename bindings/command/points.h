/// The points of --sweep. Private to bindings/command/.
#ifndef GLINT_CLI_POINTS_H
#define GLINT_CLI_POINTS_H

#include "bindings/command/cli.h"

/// Runs the script for each point of the sweep, and renders the frames of all. False: the run has failed, or some points have,
/// of which *reported says that each is reported.
bool cli_run_points(cli_options *options, cli_output *output, glintL_run *run, bool *reported);

#endif
