// The playground: a script on one side, its picture on the other.
import { control, controlStyle, ordered } from "./controls.js"
import { Gestures, gestureStyle, orbitOf, STILL } from "./gestures.js"
import { loadWithFont, quality, Renderer, show, wait } from "./renderer.js"

const TYPING_MS = 350 // delay between the last key and the script's run
const get = id => document.getElementById(id)
document.head.append(Object.assign(document.createElement("style"), { textContent: controlStyle + gestureStyle }))
const engine = loadWithFont()

let examples = []
let job, renderer, files = {}, name = "scene.lua"
let values = {}, frame = 1, playing = false, turning, due = 0

// ---- The editor ----

// Shows the script as plain text until the editor is loaded. Has the members of Editor.
const plain = { get text() { return get("script").textContent }, set text(text) { get("script").textContent = text }, mark() {} }
let editor = plain, loading, typing, marked = []
const script = () => editor.text

// Loads the editor. Called after the first picture or error, so that the editor does not delay it.
async function loadEditor() {
  const { Editor } = await import("./editor.js")
  editor = new Editor(get("editor"), editor.text, () => {
    clearTimeout(typing)
    typing = setTimeout(run, TYPING_MS)
  })
  editor.mark(...marked)
}

function setScript(text) {
  editor.text = text
  clearTimeout(typing)
  return run()
}

// ---- Errors ----

// Marks a line of the script with a message; without a message, removes the mark.
function mark(...line) {
  marked = line
  editor.mark(...marked)
  loading ??= loadEditor().catch(showError)
}

function showError(error) {
  get("error").textContent = error.message
  get("error").hidden = false
  get("state").textContent = "error"
  mark(error.file && error.file !== name ? 0 : error.line, error.message)
}

function clearError() {
  get("error").hidden = true
  mark()
}

// ---- Running the script ----

let version = 0
async function run() {
  const mine = ++version
  get("state").textContent = "running"
  try {
    const opened = await (await engine).open(script(), { name, files, seconds: 10 })
    if (mine !== version) return opened.close()
    renderer?.stop()
    job?.close()
    job = opened
    frame = Math.min(frame, job.frames)
    values = Object.fromEntries(Object.entries(values).filter(([key]) => job.params.some(param => param.name === key)))
    renderer = new Renderer(job, { page, size, shown, failed: showError, waits: ms => wait(get("wait"), ms) })
    get("error").hidden = true
    showControls()
    showPlayer()
    ask(false)
    if (!get("pane-explain").hidden) explain()
  } catch (error) {
    if (mine === version) showError(error)
  }
}

const sizeOf = width => ({ width, height: Math.max(1, Math.round(width * job.height / job.width)) })
const size = () => sizeOf(Number(get("width").value))

// Returns the size of the picture in the page, which may be too narrow for the chosen width.
const page = () => {
  get("frame-of-picture").style.width = `${size().width}px`
  return sizeOf(get("frame-of-picture").getBoundingClientRect().width)
}

const hands = new Gestures(get("hands"), {
  turned: (_, moving) => ask(moving),
  moved(name, value, moving) {
    controls.find(one => one.param.name === name)?.made.set(value)
    values = { ...values, [name]: value }
    ask(moving)
  },
  pointOf: name => values[name] ?? job.params.find(param => param.name === name).value,
  resets(name) { hands.moved(name, job.params.find(param => param.name === name).value, false) },
})

function ask(coarse) {
  const orbit = orbitOf(hands.view)
  renderer.ask({ frame, set: values, view: get("pass").value, ...orbit && { orbit } }, coarse)
}

function shown(image, { coarse, ms }) {
  show(get("picture"), get("over"), image)
  hands.update(image, name => job.params.find(param => param.name === name).label ?? name)
  get("reset").hidden = job.params.length === 0 && !image.orbit
  clearError()
  get("state").textContent = image.samples < image.ownSamples ? "refining" : coarse ? "coarse" : "ready"
  get("time").textContent = [`${image.width} × ${image.height}`, quality(image), `${Math.max(1, Math.round(ms))} ms`].filter(Boolean).join(", ")
  if (!coarse) get("save-picture").disabled = false
  clearTimeout(turning)
  if (playing) turning = setTimeout(() => playing && goTo(frame % job.frames + 1, true), Math.max(0, due - performance.now()))
}

// ---- Controls ----

let shape = ""
let controls = []
function showControls() {
  const now = JSON.stringify(job.params)
  if (now !== shape) {
    shape = now
    controls = ordered(job.params, script()).map(param => ({ param, made: control(param, (value, moving) => {
      values = { ...values, [param.name]: value }
      ask(moving)
    }) }))
    get("params").replaceChildren(...controls.map(one => one.made.element))
    for (const { param, made } of controls) if (param.name in values) made.set(values[param.name])
  }
}

function showPlayer() {
  get("player").hidden = job.frames < 2
  get("frame").max = job.frames
  if (job.frames < 2 && playing) get("play").click()
  if (job.frames > 1) goTo(frame, null)
}

function goTo(to, coarse) {
  frame = to
  due = performance.now() + 1000 / job.fps
  get("frame").value = to
  get("counter").textContent = `${to} / ${job.frames}`
  if (coarse !== null) ask(coarse)
}

get("params").addEventListener("submit", event => event.preventDefault())
get("frame").addEventListener("input", () => goTo(Number(get("frame").value), true))
get("frame").addEventListener("change", () => goTo(Number(get("frame").value), false))
get("play").addEventListener("click", () => {
  playing = !playing
  get("play").textContent = playing ? "Pause" : "Play"
  get("play").setAttribute("aria-pressed", String(playing))
  ask(playing)
})
get("reset").addEventListener("click", () => {
  for (const { param, made } of controls) made.set(param.value)
  values = {}
  hands.view = { ...STILL }
  ask(false)
})
for (const id of ["pass", "width"]) get(id).addEventListener("change", () => job && ask(false))

const PASSES = ["beauty", "ambient", "diffuse", "specular", "indirect", "mirror", "transmission", "depth", "normal", "object_id", "albedo", "outline"]
for (const pass of PASSES) get("pass").add(new Option(pass))

// ---- The scene's needs ----

const element = (tag, ...children) => {
  const made = document.createElement(tag)
  made.append(...children)
  return made
}

function table(heads, rows) {
  return element("table", element("thead", element("tr", ...heads.map(head => element("th", head)))),
    element("tbody", ...rows.map(row => element("tr", ...row.map(cell => element("td", String(cell)))))))
}

async function explain() {
  const pane = get("pane-explain")
  try {
    const plan = JSON.parse(await job.explain({ frame, set: values }))
    const callers = new Map()
    for (const { effect, caller } of plan.effects) callers.set(effect, [...callers.get(effect) ?? [], caller])
    pane.replaceChildren(
      element("p", "The renderer computes only what this scene needs."),
      table(["Effect", "Needed by"], [...callers].map(([effect, by]) => [effect, by.length > 4 ? `${by.slice(0, 3).join(", ")} and ${by.length - 3} more` : by.join(", ")])),
      table(["Stage", "What it computes"], plan.stages.map(stage => [stage.name, stage.why])),
      table(["Expected rays", ""], Object.entries(plan.rays).filter(([, count]) => count > 0).map(([kind, count]) => [kind, count.toLocaleString("en")])))
  } catch (error) {
    showError(error)
  }
}

const tabs = [get("tab-picture"), get("tab-explain")]
function choose(tab) {
  for (const one of tabs) {
    const chosen = one === tab
    one.setAttribute("aria-selected", String(chosen))
    one.tabIndex = chosen ? 0 : -1
    get(one.getAttribute("aria-controls")).hidden = !chosen
  }
  if (tab === tabs[1] && job) explain()
}
for (const tab of tabs) {
  tab.addEventListener("click", () => choose(tab))
  tab.addEventListener("keydown", event => {
    if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return
    const other = tabs[1 - tabs.indexOf(tab)]
    other.focus()
    choose(other)
  })
}

// ---- Links and files ----

const squeezed = async (bytes, stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer())

async function toHash(text) {
  const bytes = await squeezed(new TextEncoder().encode(text), new CompressionStream("deflate-raw"))
  return btoa(Array.from(bytes, byte => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")
}

async function fromHash(text) {
  const bytes = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), letter => letter.charCodeAt(0))
  return new TextDecoder().decode(await squeezed(bytes, new DecompressionStream("deflate-raw")))
}

get("share").addEventListener("click", async () => {
  const hash = `script=${await toHash(script())}`
  const of = Object.keys(files).length > 0 ? `&files=${encodeURIComponent(name)}` : ""
  history.replaceState(null, "", `#${hash}${of}`)
  try {
    await navigator.clipboard.writeText(location.href)
    get("state").textContent = "link copied"
  } catch {
    get("state").textContent = "the link is in the address bar"
  }
})

function download(data, filename, type) {
  const link = document.createElement("a")
  link.href = URL.createObjectURL(new Blob([data], { type }))
  link.download = filename
  link.click()
  setTimeout(() => URL.revokeObjectURL(link.href), 1000)
}
get("save-script").addEventListener("click", () => download(script(), name, "text/x-lua"))
get("save-picture").addEventListener("click", async () => { // the command's picture, with the script's own samples
  try {
    const picture = await job.render({ frame, set: values, view: get("pass").value, ...size() })
    download(picture.png(), name.replace(/\.lua$/, ".png"), "image/png")
  } catch (error) {
    showError(error)
  }
})

// ---- Examples ----

async function filesOf(example) {
  const read = {}
  for (const file of example.files ?? []) {
    const response = await fetch(`examples/${file}`)
    if (!response.ok) throw new Error(`examples/${file}: the server answers ${response.status}`)
    read[file] = new Uint8Array(await response.arrayBuffer())
  }
  return read
}

async function openExample(wanted) {
  const example = examples.find(one => one.name === wanted) ?? examples[0]
  get("examples").value = example.name
  const [text, read] = await Promise.all([fetch(`examples/${example.name}`).then(response => response.text()), filesOf(example)])
  name = example.name
  files = read
  values = {}
  frame = 1
  hands.view = { ...STILL }
  await setScript(text)
}

get("examples").addEventListener("change", async () => {
  history.replaceState(null, "", `#example=${get("examples").value}`)
  await openExample(get("examples").value).catch(showError)
})

// Opens a script of this site.
async function openScript(address) {
  if (address.origin !== location.origin) throw new Error(`src: expected a script of ${location.origin}, got ${address}`)
  const response = await fetch(address)
  if (!response.ok) throw new Error(`${address}: the server answers ${response.status}`)
  name = address.pathname.split("/").pop()
  return setScript(await response.text())
}

async function start() {
  examples = await (await fetch("examples/index.json")).json()
  for (const { name: file, title } of examples) get("examples").add(new Option(`${file}: ${title}`, file))
  const asked = new URLSearchParams(location.hash.slice(1))
  if (asked.has("src")) return openScript(new URL(asked.get("src"), location.href))
  if (!asked.has("script")) return openExample(asked.get("example") ?? "moving_light.lua")
  const of = examples.find(one => one.name === asked.get("files"))
  if (of) {
    name = of.name
    files = await filesOf(of)
  }
  return setScript(await fromHash(asked.get("script")))
}

start().catch(showError)
