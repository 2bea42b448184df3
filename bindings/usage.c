// glint --help.
#include "bindings/cli.h"

void cli_print_usage(FILE *out)
{
    fputs("usage: glint [render] SCRIPT [options]        render the frames that a Lua script describes\n"
          "       glint SCRIPT --help                    the script's parameters\n"
          "       glint explain SCRIPT [--frame N] [--json]   what a frame needs, and who called for it\n"
          "       glint describe SCRIPT --json           the script's parameters, for programs\n"
          "       glint compare A B [--fail X] [--warn X] [--json]\n"
          "                                              0 same, 1 warn, 2 differ, 3 size, 4 file\n"
          "       glint sheet FILES -o SHEET             a contact sheet, .png or .html, of finished frames\n"
          "       glint assemble FILES -o FILM           a film, .mp4 .webm .gif or animated .png, of finished frames\n"
          "       glint reproduce FILE SCRIPT            renders a finished frame again:\n"
          "                                              0 same bytes, 3 same pixels, 4 another picture, 5 file\n"
          "       glint new NAME                         writes a scene to begin with\n"
          "\n"
          "frames     -f, --frames 1-3,5,7-20:2,90-      frames are numbered from 1\n"
          "           -s, --start N  -e, --end N  -j, --jump N\n"
          "           --shard K/N                        the K-th of N parts\n"
          "           --sweep NAME=A:B:N                 the script for N values of a parameter\n"
          "files      -o, --output PATTERN               %04d or #### is the frame's number; .png or .pfm; none\n"
          "           --passes LIST                      background,ambient,diffuse,specular,depth,normal,object_id\n"
          "           --bits 8|16  --encode fast|small\n"
          "           --force                            render frames that are there already\n"
          "films      -o FILM.mp4, .webm, .gif (by ffmpeg), .apng; -o FILM.png --apng; --fps N\n"
          "sheets     --columns N  --label TEXT  --title TEXT  --difference N  --gain X\n"
          "picture    -D, --set NAME=VALUE               a parameter of the script\n"
          "           --size WxH  --samples N  --seed N  --precision double|float\n"
          "           --transfer srgb|linear  --rounding nearest|truncate  --tone clamp\n"
          "machine    -t, --threads N  --no-reuse  --reuse-memory SIZE\n"
          "           --repeat N                         render each frame N times, report each\n"
          "report     --json  -q, --quiet  --version  -h, --help\n"
          "\n"
          "Words after -- are the script's `arg`. What the command line says beats what the script says.\n"
          "Exit: 0 done, 1 a frame failed, 2 usage or script error, 75 disk full (try later), 130 and 143 by signal.\n",
          out);
}
