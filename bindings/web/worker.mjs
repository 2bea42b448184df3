// The worker of one job: the loader of emscripten (createGlint, inserted before this) and the answers to the messages
// of glint.mjs. One file without imports, so that a page can make a worker from its text.
//
// A message is { call, ... }; the answer is { result } or { failed: message }. { rendering } says whether the current
// time counts for a render rather than the script.

const FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf" // where glint looks for it
const MESSAGE_LINES = 1000 // lines that a script may print in one call

const port = globalThis.process?.versions?.node ? (await import("node:worker_threads")).parentPort : globalThis
let engine, sets, printed = []
const chosen = new Set() // options overridden by the page
let shown // what the engine's last picture shows, if its error can be estimated

function print(line) {
  if (printed.length < MESSAGE_LINES) printed.push(line)
}

// Calls a function of web.c. Strings are passed for the duration of the call; null stays NULL.
function call(name, ...values) {
  const texts = []
  const numbers = values.map(value => {
    if (typeof value !== "string") return value === null ? 0 : value
    const size = engine.lengthBytesUTF8(value) + 1, at = engine._malloc(size)
    engine.stringToUTF8(value, at, size)
    texts.push(at)
    return at
  })
  const result = engine["_" + name](...numbers)
  for (const at of texts) engine._free(at)
  return result
}

const text = name => engine.UTF8ToString(call(name))

function check(good) {
  if (!good) throw { failed: text("web_message") }
  return good
}

const warnings = () => text("web_warnings").split("\n").filter(line => line !== "")

// Writes a file to the file system in memory, with its folders. A relative path begins in /job.
function write(path, bytes) {
  const whole = path.startsWith("/") ? path : `/job/${path}`
  engine.FS.mkdirTree(whole.slice(0, whole.lastIndexOf("/") + 1))
  engine.FS.writeFile(whole, bytes)
}

const describe = () => ({
  params: JSON.parse(text("web_params")), frames: call("web_frames"), fps: call("web_fps"), width: call("web_width"),
  height: call("web_height"), samples: call("web_first_samples"),
  warnings: warnings(), printed,
})

// Runs the script if the parameters { name: text } differ from the last time.
function run(given) {
  const key = JSON.stringify(Object.entries(given).sort())
  if (key === sets) return
  sets = undefined // unknown until it has run
  call("web_clear_sets")
  for (const [name, value] of Object.entries(given)) check(call("web_set", name, value))
  check(call("web_run"))
  sets = key
}

async function open({ module, font, name, source, files, set, seconds }) {
  globalThis.self ??= globalThis // the loader expects it in a worker
  globalThis.location ??= { href: "" }
  engine = await createGlint({
    print, printErr: print,
    rendering: begins => port.postMessage({ rendering: begins }),
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(module, imports).then(instance => done(instance, module), error => port.postMessage({ failed: String(error) }))
      return {}
    },
  })
  if (font) write(FONT, font)
  engine.FS.mkdir("/job")
  engine.FS.chdir("/job")
  for (const [path, bytes] of Object.entries(files)) write(path, bytes)
  write(name, source)
  if (!call("web_open", name, seconds)) throw { failed: "out of memory" }
  run(set)
  return describe()
}

// Sets the given options of scene:render{}, as text; all others get the script's values.
function choose(options) {
  for (const name of chosen) if (!(name in options)) check(call("web_option", name, null))
  chosen.clear()
  for (const [name, value] of Object.entries(options)) {
    check(call("web_option", name, value))
    chosen.add(name)
  }
}

// Returns the float32 numbers of a pass: the part of an .npy after its header.
function plane(name) {
  const size = engine._malloc(4), at = call("web_plane", name, size)
  const length = new Uint32Array(engine.HEAPU8.buffer, size, 1)[0]
  engine._free(size)
  check(at)
  const head = 10 + engine.HEAPU8[at + 8] + 256 * engine.HEAPU8[at + 9]
  return new Float32Array(engine.HEAPU8.slice(at + head, at + length).buffer)
}

// Returns the names of the passes; light:* stands for all light passes.
function namePasses(passes) {
  const lights = []
  for (let at; passes.includes("light:*") && (at = call("web_light_pass", lights.length));) lights.push(`light:${engine.UTF8ToString(at)}`)
  return passes.flatMap(name => name === "light:*" ? lights : [name])
}

const keyOf = ({ set, frame, options }) => JSON.stringify([set, frame, options, call("web_samples")])

// Renders a frame. With `after`, renders the step that follows a picture of that many samples.
function render(message) {
  const { set, frame, options, passes, view, after, layers } = message
  run(set)
  choose(options)
  const own = after === undefined ? 0 : call("web_own_samples", frame), isStep = own > 1
  shown = undefined
  check(call("web_render", frame, isStep || "passes" in options, isStep ? call("web_next_samples", frame, after) : 0))
  if (isStep && view === "beauty") shown = keyOf(message)
  const width = call("web_image_width"), height = call("web_image_height")
  const since = performance.now()
  const at = check(call("web_rgba", view, layers ? 1 : 0))
  const rgba = new Uint8ClampedArray(engine.HEAPU8.slice(at, at + 4 * width * height).buffer)
  const pixelMs = call("web_pixel_ms") + performance.now() - since
  const planes = Object.fromEntries(namePasses(passes).map(name => [name, plane(name)]))
  const marks = layers && view === "beauty" ? check(call("web_marks", layers.width, layers.height, layers.scale, layers.least)) : 0
  const samples = call("web_samples")
  return {
    frame, width, height, samples, ownSamples: isStep ? own : samples, rgba, marks: engine.UTF8ToString(marks), planes, pixelMs,
    casts: call("web_casts"), orbit: Boolean(call("web_orbit")), handles: JSON.parse(text("web_handles")), warnings: warnings(), printed,
    memory: engine.HEAPU8.length,
  }
}

// Returns the estimated error of a step. undefined: the frame has no steps, or the engine has rendered another picture
// since.
function estimate(message) {
  if (keyOf(message) !== shown) return undefined
  run(message.set) // an explain may have run it with others
  choose(message.options)
  const error = call("web_estimate", message.frame)
  check(error >= 0)
  return { error, trusted: Boolean(call("web_is_trusted")) }
}

function explain({ set, frame, options }) {
  run(set)
  choose(options)
  const at = check(call("web_explain", frame))
  return engine.UTF8ToString(at)
}

const calls = { open, render, estimate, explain }

async function answer(message) {
  printed = []
  try {
    const result = await calls[message.call](message)
    const moved = result?.rgba ? [result.rgba.buffer, ...Object.values(result.planes).map(numbers => numbers.buffer)] : []
    port.postMessage({ result }, moved)
  } catch (error) {
    // After a failure of the engine itself its memory must not be used again.
    port.postMessage(error?.failed !== undefined ? { failed: error.failed } : { failed: String(error), broken: true })
  }
}

if (port.on) port.on("message", answer)
else port.onmessage = event => answer(event.data)
