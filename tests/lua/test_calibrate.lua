-- A part of `make calibrate`: three scenes, three seeds, small pictures.
local tally = dofile "tests/lua/tally.lua"
local found = dofile "tests/bench/calibrate.lua" (3, 3, "48x27")
tally.check(#found.quotients == 9 and found.held >= 7, "--until-light holds in %d of %d", found.held, #found.quotients)
tally.check(found.median > 0.8 and found.median < 1.4, "stated by true error: %g", found.median)
tally.check(found.right == found.decided, "the advice is right in %d of %d", found.right, found.decided)
tally.check(found.decided + found.undecided == 9, "every study has advice: %d, %d", found.decided, found.undecided)
tally.finish()
