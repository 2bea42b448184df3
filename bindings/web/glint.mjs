// glint for pages, workers and Node: loads the engine, opens scripts and renders their frames. Each job has its own
// worker.
//
//   import { load } from "./glint.mjs"
//   const glint = await load()
//   const job = await glint.open(source, { name: "scene.lua", files: { "earth.png": bytes }, set: { radius: 12 } })
//   const image = await job.render({ frame: 7, width: 640, height: 360, set: { radius: 13 } })
//
// The manual is bindings/README.md, "In a browser".

import { encode } from "fast-png"

const isNode = !!globalThis.process?.versions?.node
const GRACE_S = 1 // beyond the script's time, for script code that Lua's hook cannot interrupt

/** An error of the engine or the script, with the command's message. `file` and `line`: position, if known. */
export class GlintError extends Error {
  constructor(message) {
    super(message)
    this.name = "GlintError"
    const where = /(?:^|: )([^\s:][^:\n]*):(\d+): /.exec(message) ?? /\n {2}called from ([^\n]*):(\d+)/.exec(message)
    this.file = where ? where[1] : undefined
    this.line = where ? Number(where[2]) : undefined
  }
}

// Returns a parameter or an option as text, as after --set NAME=.
const spell = value => Array.isArray(value) ? value.join(",") : String(value)
const spellAll = values => Object.fromEntries(Object.entries(values ?? {}).map(([name, value]) => [name, spell(value)]))

const aborted = signal => signal.reason ?? new DOMException("The operation was aborted.", "AbortError")

/** A rendered frame. */
class Image {
  #planes
  constructor(result) {
    const { planes, ...rest } = result
    // frame, width, height, rgba, marks, warnings, printed, memory: bytes used by the engine; samples and ownSamples of a
    // pixel: the picture's and the full picture's; pixelMs: time for the pixels; casts: primary rays that were cast
    Object.assign(this, rest)
    this.#planes = planes
  }
  /** The float32 numbers of a requested pass, row by row from the top, as in a .pfm. */
  plane(name = "beauty") {
    if (!(name in this.#planes)) throw new GlintError(`plane: '${name}' was not rendered; request it with passes: ["${name}"]`)
    return this.#planes[name]
  }
  /** The picture as a PNG file, in bytes; without an alpha channel if every pixel is opaque. */
  png() {
    const { width, height, rgba } = this
    const isOpaque = rgba.every((value, i) => i % 4 < 3 || value === 255)
    return encode(isOpaque ? { width, height, data: rgba.filter((_, i) => i % 4 < 3), channels: 3 } : { width, height, data: rgba })
  }
  /** For a canvas: context.putImageData(image.data(), 0, 0). */
  data() { return new ImageData(this.rgba, this.width, this.height) }
}

// ---- A worker and its queue of requests ----

const CLOSED = "the job is closed"

class Host {
  #engine
  #opening
  #seconds
  #queue = [] // the first request is being processed
  #worker
  #timer
  #isOpen = false // the worker has run the script
  #isReopening = false
  #isClosed = false
  #since // when the worker got the message that it is processing
  #openingMs = 0 // time that a new worker needs
  constructor(engine, opening) {
    this.#engine = engine
    this.#opening = opening
    this.#seconds = opening.seconds
  }

  // Sends a message after the earlier ones, and returns a promise of its answer.
  ask(message, signal) {
    if (signal?.aborted) return Promise.reject(aborted(signal))
    if (this.#isClosed) return Promise.reject(new GlintError(CLOSED))
    return new Promise((resolve, reject) => {
      const asked = { message, resolve, reject, signal }
      asked.abort = () => this.#abort(asked)
      signal?.addEventListener("abort", asked.abort, { once: true })
      this.#queue.push(asked)
      if (this.#queue.length === 1) this.#begin()
    })
  }

  close() {
    this.#isClosed = true
    this.#stop()
    for (const asked of this.#queue.splice(0)) this.#settle(asked, "reject", new GlintError(CLOSED))
  }

  #settle(asked, how, value) {
    asked.signal?.removeEventListener("abort", asked.abort)
    asked[how](value)
  }

  // A new worker opens the script first, also if it replaces a worker that was stopped.
  #begin() {
    while (this.#queue[0]?.signal?.aborted) this.#queue.shift()
    const asked = this.#queue[0]
    if (!asked) return this.#worker?.unref?.()
    if (!this.#worker) {
      const worker = this.#engine.start( // messages of a stopped worker are ignored
        data => worker === this.#worker && this.#take(data), error => worker === this.#worker && this.#fail(error))
      this.#worker = worker
      this.#isOpen = false
    }
    this.#worker.ref?.()
    const first = this.#isOpen || asked.message.call === "open" ? asked.message : this.#opening
    this.#isReopening = first !== asked.message
    this.#since = performance.now()
    this.#watch()
    this.#worker.postMessage({ ...first, ...(first.call === "open" ? { module: this.#engine.module, font: this.#engine.font } : {}) })
  }
  #watch() {
    clearTimeout(this.#timer)
    this.#timer = setTimeout(() => this.#fail(new GlintError(`the script took longer than ${this.#seconds} s`)), 1e3 * (this.#seconds + GRACE_S))
  }

  #take(data) {
    clearTimeout(this.#timer)
    if (data.rendering === true) return
    if (data.rendering === false) return this.#watch()
    if (data.failed !== undefined) return this.#fail(new GlintError(data.failed), this.#isOpen && !data.broken)
    if (!this.#isOpen) this.#openingMs = performance.now() - this.#since
    this.#isOpen = true
    if (!this.#isReopening) this.#settle(this.#queue.shift(), "resolve", data.result)
    this.#begin()
  }

  #fail(error, goesOn = false) {
    clearTimeout(this.#timer)
    if (!goesOn) this.#stop()
    const asked = this.#queue.shift()
    if (asked) this.#settle(asked, "reject", error)
    this.#begin()
  }

  #stop() {
    clearTimeout(this.#timer)
    this.#worker?.terminate()
    this.#worker = undefined
  }

  // Rejects a request. A worker that is processing it may complete it, for as long as a new worker would take to open the
  // script.
  #abort(asked) {
    this.#settle(asked, "reject", aborted(asked.signal))
    const place = this.#queue.indexOf(asked)
    if (place > 0) this.#queue.splice(place, 1)
    if (place === 0) setTimeout(() => this.#drop(asked), Math.max(0, this.#openingMs - (performance.now() - this.#since)))
  }
  #drop(asked) {
    if (this.#queue[0] !== asked || this.#isReopening) return // an opened worker skips it
    this.#queue.shift()
    this.#stop()
    this.#begin()
  }
}

/** An opened script. */
class Job {
  #host
  #set
  #open
  constructor(host, set, opened, open) {
    this.#host = host
    this.#set = set
    this.#open = open
    Object.assign(this, opened) // params, frames, fps, width, height, samples, warnings, printed
  }
  /** Opens the script again, in another worker. */
  another() { return this.#open() }
  /**
   * Renders a frame. `set` overrides the values the job was opened with. `passes` are the passes whose numbers
   * image.plane() returns; they take extra time. `view` is the pass that image.rgba shows, as in its .png. With `layers`,
   * { width, height, least }, image.rgba has no overlays: image.marks has them as an SVG element for a page that shows
   * the picture at this size, with letters of at least `least` pixels. The other options are the fields of scene:render{}.
   */
  async render(options) { return new Image(await this.#ask("render", options)) }

  /**
   * Renders a frame in steps: yields pictures with 1, 2, 4 ... samples, and the picture of render() as the last. Yields a
   * picture again when `image.error`, the estimated error of its beauty pass, is known; `image.trusted` is false if the
   * estimate is not to be trusted, because few pixels hold most of the error. Frames of one sample, pictures
   * that take less than a tenth of a second, and calls of scene:render have no steps before the last.
   */
  async *steps(options) {
    let image
    do {
      image = new Image(await this.#ask("render", options, { after: image?.samples ?? 0 }))
      yield image
      const estimate = image.samples > 1 ? await this.#ask("estimate", options) : undefined
      if (estimate !== undefined) yield Object.assign(image, estimate)
    } while (image.samples < image.ownSamples)
  }

  #ask(call, { frame = 1, passes = [], view = "beauty", layers, set, signal, ...options } = {}, more) {
    const named = [passes].flat().flatMap(list => String(list).split(",")).filter(name => name !== "")
    const needed = view === "beauty" || named.includes(view) ? named : [...named, view]
    const on = layers && { least: 0, scale: layers.width / this.width, ...layers }
    const message = { call, frame, view, layers: on, set: { ...this.#set, ...spellAll(set) }, passes: named, options: spellAll(options), ...more }
    if (needed.length) message.options.passes = needed.join(",")
    message.options.bits = "8" // a page shows no more
    return this.#host.ask(message, signal)
  }
  /** Returns the output of `glint explain --json` for a frame. */
  explain({ frame = 1, set, signal, ...options } = {}) {
    return this.#host.ask({ call: "explain", frame, set: { ...this.#set, ...spellAll(set) }, options: spellAll(options) }, signal)
  }
  /** Ends the worker. Its unanswered requests fail. */
  close() { this.#host.close() }
}

// ---- The engine ----


// Returns the answer of a server, or a file's, for a file next to this module.
async function fetched(address) {
  const url = new URL(address, import.meta.url)
  if (isNode && url.protocol === "file:") return new Response(await (await import("node:fs/promises")).readFile(url))
  const answer = await fetch(url)
  if (!answer.ok) throw new GlintError(`${url}: ${answer.status} ${answer.statusText}`)
  return answer
}

const areBytes = value => value instanceof ArrayBuffer || ArrayBuffer.isView(value)

async function compile(wasm) {
  if (wasm instanceof WebAssembly.Module) return wasm
  if (areBytes(wasm)) return WebAssembly.compile(wasm)
  const answer = wasm instanceof Response ? wasm : await fetched(wasm) // a server that knows the type lets the browser compile while it loads
  const isStream = answer.headers.get("content-type") === "application/wasm"
  return isStream ? WebAssembly.compileStreaming(answer) : WebAssembly.compile(await answer.arrayBuffer())
}

async function readFont(font) {
  if (areBytes(font)) return new Uint8Array(font)
  const answer = font === true ? await fetched("glint.ttf").catch(() => null) : await fetched(font)
  return answer ? new Uint8Array(await answer.arrayBuffer()) : undefined
}

class Engine {
  #make
  #spare
  constructor(make) {
    this.#make = make
    this.#spare = isNode ? undefined : make() // the browser reads the worker while it compiles the module
  }
  // Starts a worker. `take` receives its messages; `fail` is called when the worker cannot continue.
  start(take, fail) {
    const worker = this.#spare ?? this.#make()
    this.#spare = undefined
    if (worker.on) {
      worker.on("message", take)
      worker.on("error", error => fail(new GlintError(String(error))))
    } else {
      worker.onmessage = event => take(event.data)
      worker.onerror = event => fail(new GlintError(event.message ?? "the worker could not be started"))
    }
    return worker
  }
}

/**
 * Loads the engine. wasm: glint.wasm as a URL, bytes, a Response or a module; worker: the URL of worker.mjs. With a blob URL, the
 * text of worker.mjs runs in an async function. font: a TrueType font as a URL or bytes; true: glint.ttf next to
 * glint.mjs, which has letters of DejaVu Sans; without a font, letters are of the bitmap font.
 */
export async function load({ wasm = "glint.wasm", worker, font } = {}) {
  const url = new URL(worker ?? "worker.mjs", import.meta.url)
  const isBlob = url.protocol === "blob:" // a page opened from disk cannot make a module worker from a blob
  const Worker = isNode ? (await import("node:worker_threads")).Worker : globalThis.Worker
  const engine = new Engine(() => new Worker(url, isBlob ? {} : { type: "module" }))
  ;[engine.module, engine.font] = await Promise.all([compile(wasm), font && readFont(font)])
  return {
    /** The bytes of the font; undefined: the bitmap font. */
    font: engine.font,
    /** Runs a script. files: { name: text or bytes } to read; set: { name: value }; seconds: limit of each call. */
    async open(source, { name = "scene.lua", files = {}, set = {}, seconds = 10, signal } = {}) {
      const given = spellAll(set)
      const message = { call: "open", name, source, files, set: given, seconds }
      const begin = async signal => {
        const host = new Host(engine, message)
        try {
          return new Job(host, given, await host.ask(message, signal), begin)
        } catch (error) {
          host.close()
          throw error
        }
      }
      return begin(signal)
    },
  }
}
