/// The points of --sweep. Private to bindings/command/.
#ifndef GLINT_CLI_POINTS_H
#define GLINT_CLI_POINTS_H

#include "bindings/command/cli.h"

/// Runs the script for each point of the sweep and renders all frames. False: the run has failed, or some points have;
/// *reported: each failure was reported.
bool cli_run_points(cli_options *options, cli_output *output, glintL_run *run, bool *reported);
/// Finds the axes of the job that contains run->explain_frame, including the axes of --sweep, and writes their order to
/// run->explain_order. The script must return its frames and not render by calls. False: some points have failed, each
/// of which is reported, or the run has failed.
bool cli_order_points(cli_options *options, cli_output *output, glintL_run *run);

#endif
