-- english.lua [--list] FILE...: counts comment lines and lines of pages with a phrase that is hard to read. Fails if
-- more than 2 lines in 100 have one. --list prints them. This only catches slips: a sentence can be hard to read
-- without any of these phrases, and a phrase can be right in its context.
local MOST = 0.02

-- Each entry is a phrase and what to write instead. %f[%w] is a word's beginning, %f[%W] its end.
local PHRASES = {
  { "^Of [%w-]+", "begin with the subject" },
  { "[.:;] Of [a-z]+", "begin with the subject" },
  { "^What [a-z]+", "begin with the subject", except = "%?" },
  { "[.:;] What [a-z]+", "begin with the subject", except = "%?" },
  { "^Whose ", "begin with the subject" },
  { "^Where what ", "begin with the subject" },
  { "^That of ", "repeat the noun" },
  { "%f[%w]that of the%f[%W]", "repeat the noun" },
  { "%f[%w]that of a%f[%W]", "repeat the noun" },
  { "%f[%w]those of%f[%W]", "repeat the noun" },
  { "%f[%w]but for%f[%W]", "except" },
  { "%f[%w]in place of%f[%W]", "instead of" },
  { "%f[%w]in their place%f[%W]", "instead" },
  { "%f[%w]ways of light%f[%W]", "paths" },
  { "%f[%w]its way%f[%W]", "path, ray, direction" },
  { "%f[%w]on the way%f[%W]", "path, ray, direction" },
  { "%f[%w]comes? upon%f[%W]", "hits" },
  { "%f[%w]is kept%f[%W]", "is cached, is stored" },
  { "%f[%w]are kept%f[%W]", "are cached, are stored" },
  { "%f[%w]was kept%f[%W]", "was cached" },
  { "%f[%w]what is kept%f[%W]", "cached results" },
  { "%f[%w]is told%f[%W]", "is reported" },
  { "%f[%w]told of%f[%W]", "reported, warned about" },
  { "%f[%w]told apart%f[%W]", "distinguished" },
  { "%f[%w]what is left of%f[%W]", "transmitted light, the rest" },
  { "%f[%w]worked out%f[%W]", "computed" },
  { "%f[%w]found again%f[%W]", "computed again" },
  { "%f[%w]the same but%f[%W]", "the same except" },
  { "%f[%w]%w+s? alone%f[%W][.,:;)]", "only" },
  { "%f[%w]as it is called for%f[%W]", "when the scene needs it" },
  { "%f[%w]called for by%f[%W]", "needed by" },
  { "%f[%w]is asked for%f[%W]", "say who asks" },
  { "%f[%w]of its own accord%f[%W]", "on its own" },
  { "%f[%w]the former%f[%W]", "repeat the noun" },
  { "%f[%w]the latter%f[%W]", "repeat the noun" },
  { "%f[%w]whose [%w ]+ is what", "two sentences" },
  { "%f[%w]of what%f[%W]", "name it" },
  { "%f[%w]from what%f[%W]", "name it" },
  { "%f[%w]to what%f[%W]", "name it" },
  { "%f[%w]by what%f[%W]", "name it" },
  { "%f[%w]with what%f[%W]", "name it" },
  { "%f[%w]and what%f[%W]", "name it" },
  { "%f[%w]which of them%f[%W]", "name them" },
}

local COMMENTS = { c = "//+[/!<]*", h = "//+[/!<]*", lua = "%-%-+", sh = "#+", mjs = "//+", js = "//+", awk = "#+" }

-- Calls visit(text, number) for each comment line of a file, or for each line of prose of a page.
local function each_line(path, visit)
  local kind = path:match "%.(%w+)$" or (path:find "Makefile$" and "sh")
  local file = assert(io.open(path, "r"))
  local number, fenced, started = 0, false, COMMENTS[kind]
  for line in file:lines() do
    number = number + 1
    if kind == "md" then
      if line:find "^```" then fenced = not fenced
      elseif not fenced and line:find "%a" and not line:find "^    " then visit(line, number) end
    elseif started then
      local text = line:match("^%s*" .. started .. "%s+(.*)") or line:match("[;{},)]%s+" .. started .. "%s+(.*)")
      if text and text:find "%a" then visit(text, number) end
    end
  end
  file:close()
end

local list, lines, found = false, 0, 0
for _, path in ipairs(arg) do
  if path == "--list" then
    list = true
  else
    each_line(path, function(text, number)
      lines = lines + 1
      for _, phrase in ipairs(PHRASES) do
        local hit = text:match(phrase[1])
        if hit and not (phrase.except and text:find(phrase.except)) then
          found = found + 1
          if list then print(("%s:%d: %s (%s)\n    %s"):format(path, number, hit, phrase[2], text)) end
          break
        end
      end
    end)
  end
end
local share = found / math.max(lines, 1)
print(("%d of %d lines of comments and pages have a phrase that readers stumble on: %.1f %%"):format(found, lines, 100 * share))
os.exit(share <= MOST)
