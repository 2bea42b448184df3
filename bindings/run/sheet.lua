-- The page of a sheet: sheet.html with its @NAMES@ replaced. A zero byte marks the place of the pictures.
local the = ...

local function html(text) return (text:gsub("[<&]", { ["<"] = "&lt;", ["&"] = "&amp;" })) end

-- Returns a JavaScript string that cannot end its script element; newlines become two spaces.
local ESCAPES <const> = { ['"'] = '\\"', ["\\"] = "\\\\", ["<"] = "\\u003c", ["\n"] = "  " }
local function quoted(text)
  return '"' .. text:gsub('[\1-\31"\\<]', function(c) return ESCAPES[c] or " " end) .. '"'
end

local function axis(a)
  local values = {}
  for i, value in ipairs(a.values) do values[i] = quoted(value) end
  return "  { name: " .. quoted(a.name) .. ", values: [" .. table.concat(values, ", ") .. "] },\n"
end

function the.sheet(sheet)
  local axes, labels = {}, {}
  for i, a in ipairs(sheet.axes or {}) do axes[i] = axis(a) end
  if not sheet.axes then -- without a grid, one slider goes through all pictures
    local every = "Array.from({ length: %d }, (_, i) => String(i + 1))"
    axes[1] = ('  { name: "picture", values: ' .. every .. " },\n"):format(#sheet.labels)
  end
  for i, label in ipairs(sheet.labels) do labels[i] = quoted(label) .. ",\n" end
  local title = html(sheet.title or "Contact sheet")
  return (sheet.page:gsub("@(%u+)@", { VERSION = sheet.version, TITLE = title,
    HEADING = sheet.title and "<h1>" .. title .. "</h1>\n" or "", DIFFERENCE = ("%d"):format(sheet.difference),
    GAIN = ("%g"):format(sheet.gain), GRID = sheet.axes and "true" or "false", AXES = table.concat(axes),
    LABELS = table.concat(labels),
    LIVE = sheet.live and "<h2>Try it</h2>\n" .. sheet.live or "", PICTURES = "\0" }))
end
