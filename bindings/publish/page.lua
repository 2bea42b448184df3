-- The page of glint publish: page.html with its @NAMES@ replaced. It needs no network and no server. --live inserts its
-- figure into other pages.
local the = ...

local MARGIN <const> = 34 -- CSS pixels beside the picture in page.html
local FILE_BYTES_MAX <const> = 64 << 20 -- limit of one file that the script reads

-- Returns the bytes of a file; nil and the reason if it cannot be read.
local function read(path)
  local file <close>, why = io.open(path, "rb")
  if not file then return nil, why end
  if file:seek "end" > FILE_BYTES_MAX then return nil, path .. ": File too large" end -- a folder has no end
  file:seek "set"
  return file:read "a"
end

local function must_read(path)
  local bytes, why = read(path)
  return bytes or error(why, 0)
end

-- Reads a file of the folder made by `make web`: GLINT_WEB, web/ next to the command, or ../share/glint/web.
local function read_part(my, name)
  local given, program = os.getenv "GLINT_WEB", my.program
  if given and given ~= "" then return (read(given .. "/" .. name)) end
  return program and (read(program .. "web/" .. name) or read(program .. "../share/glint/web/" .. name))
end

-- Returns a title for a script without one: "phong_lobe.lua" gives "Phong lobe".
local function title_of(script)
  return (script:gsub("%.lua$", ""):gsub("[_-]+", " "):gsub("^%l", string.upper))
end

-- Reads the engine for pages, renders the frame, and reads the script's files.
local function make_page(my)
  local wasm, engine, font = read_part(my, "glint.wasm.gz"), read_part(my, "publish.js"), read_part(my, "glint.ttf")
  if not (wasm and engine) then
    error(my.who .. ": the engine for pages is missing (glint.wasm.gz, publish.js). Build it with `make web`, then run "
      .. "build/glint, or install glint again", 0)
  end
  local page = my.render()
  page.title = page.title or title_of(page.script)
  page.wasm, page.engine, page.font, page.source = wasm, engine, font, must_read(page.path)
  page.folder = page.path:match "^.*/" or ""
  for name, path in pairs(page.files) do page.files[name] = must_read(path) end
  return page
end

local function html(text)
  return (text:gsub("[&<>\"']", { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;", ['"'] = "&quot;", ["'"] = "&#39;" }))
end

-- Returns JSON for values and for tables with names.
local function json(value)
  if type(value) ~= "table" then return the.json(value) end
  local list = {}
  for name, one in pairs(value) do list[#list + 1] = the.json(name) .. ":" .. json(one) end
  table.sort(list)
  return "{" .. table.concat(list, ",") .. "}"
end

-- Returns the JSON of a job and of its parameters, with "<" escaped, so that no text can end its script element.
local function embedded(job, params)
  return (('{"params":' .. params .. "," .. json(job):sub(2)):gsub("<", "\\u003c"))
end

-- Returns the values of --set that differ from the script's own.
local function values_of(params)
  local values = {}
  for _, param in ipairs(params) do
    if param.value ~= param.default then values[param.name] = param.value end
  end
  return values
end

local function attributes_of(page)
  local list = { ('width="%d" height="%d" frame="%d"'):format(page.width, page.height, page.frame) }
  if page.controls then list[2] = ('controls="%s"'):format(html(page.controls)) end
  return table.concat(list, " ")
end

-- Returns the page's files. Those in the script's folder have relative names; `same` maps full names to them.
local function files_of(page)
  local files, same = {}, {}
  for name, bytes in pairs(page.files) do
    local is_beside = page.folder ~= "" and name:sub(1, #page.folder) == page.folder
    local short = is_beside and name:sub(#page.folder + 1) or name
    files[short] = the.base64(bytes)
    if is_beside then same[name] = short end
  end
  return files, same
end

local function listing(source)
  return "<details><summary>Script</summary>\n<pre><code>" .. html(source) .. "</code></pre></details>"
end

local function check_controls(page)
  local known = {}
  for _, param in ipairs(page.params) do known[#known + 1], known[param.name] = param.name, true end
  for name in (page.controls or ""):gmatch "[^,]+" do
    if not known[name] then
      local list = #known > 0 and "its parameters are " .. table.concat(known, ", ") or "it has no parameters"
      error(("--controls: the script has no parameter '%s'; %s"):format(name, list), 0)
    end
  end
end

-- The font of labels, of the still picture and of the engine; without it the engine has the bitmap font.
local FONT <const> = '@font-face { font-family: "DejaVu Sans"; src: url("data:font/ttf;base64,%s"); }'

-- The still picture, which readers without JavaScript keep, has its overlays for two widths of the page.
local FIGURE <const> = [[
<style id="glint-font">@FONT@</style>
<style>
  glint-figure { display: block; position: relative; }
  glint-figure > img { display: block; max-width: 100%; height: auto; }
  glint-figure > svg { position: absolute; inset: 0; width: 100%; height: 100%; white-space: pre; }
  glint-figure > svg { user-select: none; pointer-events: none; }
  @media (min-width: @LIMIT@px) { glint-figure > .narrow { display: none; } }
  @media not all and (min-width: @LIMIT@px) { glint-figure > .wide { display: none; } }
</style>
<glint-figure @ATTRIBUTES@ style="max-width: @WIDTH@px">
<img src="data:image/png;base64,@POSTER@" width="@WIDTH@" height="@HEIGHT@" alt="@TITLE@">
@OVERLAYS@
</glint-figure>
<script type="application/json" id="glint-job">@JOB@</script>
<script type="application/octet-stream" id="glint-wasm">@WASM@</script>
<script type="module">@ENGINE@</script>
]]

-- Returns the overlays of the still picture: SVG elements for pages that have its width, and for narrow ones.
local function overlays_of(page)
  local list = {}
  for _, kind in ipairs { "wide", "narrow" } do
    if page[kind] then list[#list + 1] = page[kind]:gsub("^<svg", '<svg class="' .. kind .. '" aria-hidden="true"') end
  end
  return table.concat(list, "\n")
end

local function fill(template, values)
  return (template:gsub("@(%u+)@", function(name) return values[name] and tostring(values[name]) end))
end

-- Returns the picture with its controls and everything that they need.
local function figure_of(page)
  check_controls(page)
  local files, same = files_of(page)
  return fill(FIGURE, {
    TITLE = html(page.title), WIDTH = page.width, HEIGHT = page.height, ATTRIBUTES = attributes_of(page),
    POSTER = the.base64(page.poster), WASM = the.base64(page.wasm), ENGINE = page.engine,
    FONT = page.font and FONT:format(the.base64(page.font)) or "",
    LIMIT = page.width + MARGIN, OVERLAYS = overlays_of(page),
    JOB = embedded(
      { name = page.script, text = page.source, files = files, same = same, values = values_of(page.params) },
      the.params(page.params)),
  })
end

function the.live(my) return figure_of(make_page(my)) end

function the.publish(my)
  local page = make_page(my)
  return fill(page.template, {
    VERSION = page.version, TITLE = html(page.title), WIDTH = page.width, FIGURE = figure_of(page),
    SOURCE = page.shows_source and listing(page.source) or "",
  })
end
