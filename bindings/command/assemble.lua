-- Makes a film of finished frames (glint assemble).
local the = ...

function the.run(my)
  local given = my.options
  local kind = given.output and my.film_kind(given.output) or "none"
  if kind == "none" then my.fail(2, "-o: expected the name of a film, ending in .mp4, .webm, .gif, .png or .apng") end
  if given.apng and kind ~= "apng" then my.fail(2, "--apng: expected -o with a name ending in .png") end
  if kind == "gif" and given.fps and given.fps > 50 then
    my.fail(2, "a GIF has at most 50 frames a second; --fps 50 or less expected")
  end
  my.assemble(the.files(my))
end
