-- A sheet as one HTML page: a slider for each axis, with the pictures as data URIs. The page needs no other files.
local the = ...
local M, sheets = {}, the.sheet
local format, match, gsub, sub = string.format, string.match, string.gsub, string.sub
local concat, ipairs = table.concat, ipairs

local USAGE <const> = 2 -- exit code

local function html(text) return (gsub(text, "[<&]", { ["<"] = "&lt;", ["&"] = "&amp;" })) end

-- Returns a JavaScript string that cannot end its script element; newlines become two spaces.
local ESCAPES <const> = { ['"'] = '\\"', ["\\"] = "\\\\", ["<"] = "\\u003c", ["\n"] = "  " }
local function quoted(text)
  return '"' .. gsub(text, '[\1-\31"\\<]', function(c) return ESCAPES[c] or " " end) .. '"'
end

local function list_axes(sheet, axes)
  if not axes.is_grid then -- one slider goes through all pictures
    local every = "Array.from({ length: %d }, (_, i) => String(i + 1))"
    return format('  { name: "picture", values: ' .. every .. " },\n", axes.cells)
  end
  local out = {}
  for a, axis in ipairs(axes) do
    local values = {}
    for i in ipairs(axis.values) do values[i] = quoted(sheets.spell_value(sheet, axis, i)) end
    out[a] = "  { name: " .. quoted(sheets.axis_title(sheet, axis)) .. ", values: [" .. concat(values, ", ") .. "] },\n"
  end
  return concat(out)
end

-- Returns the script that sets the text of an element: with formulas if one of the texts may have some.
local function set_text(texts)
  if not match(texts, "%$") then return "const setText = (element, text) => { element.textContent = text };" end
  local symbols = {}
  for i, command in ipairs(the.formula_commands()) do
    symbols[i] = format("%s: [%s, %s]", quoted(command.name), quoted(command.text), quoted(command.kind))
  end
  local source = gsub(gsub(the.formula_source(), "\nexport ", "\n"), '\nimport symbols from "[^"]*"', "")
  return "const setText = (() => {\nconst symbols = { " .. concat(symbols, ", ") .. " };\n" .. source ..
    "return setText })();"
end

-- Writes the page. Returns the exit code and a message.
function M.make(sheet, axes, pictures, labels)
  local quotes, title = {}, html(sheet.title or "Contact sheet")
  for i, picture in ipairs(pictures) do
    if picture.bits > 16 then return USAGE, sub(sheet.files[i], 1, 300) .. ": a page shows only .png files" end
    quotes[i] = quoted(labels[i]) .. ",\n"
  end
  local fields = { VERSION = the.version, TITLE = title, HEADING = sheet.title and "<h1>" .. title .. "</h1>\n" or "",
    DIFFERENCE = format("%d", sheet.difference or 0), GAIN = format("%g", sheet.gain or sheets.GAIN),
    GRID = axes.is_grid and "true" or "false", AXES = list_axes(sheet, axes), LABELS = concat(quotes),
    SET_TEXT = set_text(title .. list_axes(sheet, axes) .. concat(quotes)),
    LIVE = sheet.live and "<h2>Try it</h2>\n" .. sheet.live or "" }
  local head, tail = match(the.page_of_sheets(), "^(.*)@PICTURES@(.*)$")
  return the.write_page(sheet.path, (gsub(head, "@([%u_]+)@", fields)), sheet.files, tail)
end

return M
