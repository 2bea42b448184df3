// <glint-figure>: a picture with controls, rendered in the page.
//
//   <script type="module" src="glint-figure.js"></script>
//   <glint-figure src="phong.lua" n="32" width="640" height="360">
//     <img src="phong.png" alt="A sphere under a lamp">
//   </glint-figure>
//
// Attributes:
//   src        address of the script, or of a page of glint publish; without it, the text of a <script type="text/x-lua">
//              inside the element, which may have a name. With both, the text inside is used
//   files      addresses of the files that the script reads, separated by commas; the script uses the last part of each
//   controls   names of the script's parameters with a control, separated by commas; default: all parameters
//   width, height   size of the picture, in CSS pixels, as of an img; width also in per cent. A narrower page makes the picture
//              smaller. Default: the script's size
//   frame      first frame shown, from 1
//   timing     shows the samples of the last picture, its estimated error, and how long it took
//   NAME       value of the parameter NAME; set-NAME if the name is one of these attributes or one of HTML. The element
//              writes the reader's values into these attributes. Attributes have no capitals: of the parameters n and N, only
//              n has one
// A full picture of several samples appears in steps, with 1, 2, 4 ... samples and their estimated errors.
// A page may set `figure.given = { name, text, files, values, params }` instead of src and files. The picture inside the
// element is shown until the first frame is rendered, and without JavaScript. `figure.values` has the changed values;
// `figure.set({ n: 32 })` changes some. Each change by the reader sends the event "value" with the `detail`
// { name, value, moving }. Each finished picture sends "glint-render" with { image, coarse, ms }, and again when image.error is
// known. coarse: a better picture follows. An error sends "glint-error" with { error }.
import { control, controlStyle, fault, ordered, parsed, spelled } from "./controls.js"
import { Gestures, gestureStyle, orbitOf, STILL, viewOf } from "./gestures.js"
import { copyLink, readLink } from "./link.js"
import { Player } from "./player.js"
import { loadWithFont, quality, Renderer, show, wait } from "./renderer.js"
import { listed, sourceOf } from "./source.js"

const OWN = ["src", "files", "controls", "width", "height", "frame", "timing", "id", "class", "style", "title", "lang", "dir", "hidden", "slot",
  "role", "tabindex", "part", "is", "name", "data", "inert", "draggable", "translate", "autofocus", "nonce", "popover"]

let engine // one for all figures of a page
const engineOfPage = () => engine ??= loadWithFont()

// Makes the page's figures use this promise of an engine. Call it before the first figure starts.
export function useEngine(promise) {
  engine = promise
}

const style = `
  :host { display: block; font: 0.9375rem/1.4 system-ui, sans-serif; max-width: 100%; }
  [hidden] { display: none !important; }
  figure { margin: 0; }
  .picture { position: relative; }
  .picture canvas { display: block; width: 100%; height: 100%; }
  .picture ::slotted(img) { display: block; width: 100%; height: auto; }
  .over, .over svg { position: absolute; inset: 0; width: 100%; height: 100%; }
  .over { pointer-events: none; user-select: none; }
  .over text { white-space: pre; }
  .wait { position: absolute; bottom: 0; width: 100%; height: 3px; background: #4a90d9; transform-origin: left; }
  .error { margin: 0; padding: 0.6em 0.8em; white-space: pre-wrap; overflow-wrap: anywhere; font: 0.8125rem/1.4 ui-monospace, monospace;
    background: #8b1a1a; color: #fff; }
  form { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(15rem, 100%), 1fr)); gap: 0.75rem 1.5rem; margin: 0.6rem 0; }
  form.waits { visibility: hidden; }
  .timing { flex: 1 1 6rem; contain: inline-size; font-size: 0.875rem; min-height: 1lh; }
  :host([timing]) .timing { flex-basis: 12rem; }
  .note { font-variant-numeric: tabular-nums; color: color-mix(in srgb, currentColor 75%, transparent); }
  .bar { display: flex; flex-wrap: wrap; gap: 0.5rem 0.75rem; align-items: center; margin: 0.5rem 0; }
  .bar input { flex: 1 1 8rem; min-width: 0; }
  .counter { min-width: 4.5em; text-align: end; }
  button { font: inherit; padding: 0.25rem 0.8rem; min-height: 2rem; }
  @media (pointer: coarse), (max-width: 30rem) {
    .bar button, .bar input { min-height: 2.75rem; min-width: 2.75rem; }
    :host([timing]) .timing { min-height: 2lh; }
  }
${controlStyle}${gestureStyle}`

export class GlintFigure extends HTMLElement {
  constructor() {
    super()
    const root = this.attachShadow({ mode: "open" })
    root.innerHTML = `<style>${style}</style>
      <figure><div class="picture"><slot></slot><canvas role="img" hidden></canvas>
        <div class="over" aria-hidden="true"></div><div class="hands" hidden></div><div class="wait" hidden></div></div>
      <pre class="error" role="alert" hidden></pre>
      <div class="bar player" hidden><button type="button" class="play" aria-pressed="false">Play</button>
        <input type="range" class="frames" min="1" step="1" value="1" aria-label="Frame"><span class="note counter"></span></div>
      <form hidden></form>
      <div class="bar foot" hidden><button type="button" class="reset">Reset</button><button type="button" class="link">Copy link</button>
        <span class="note timing" role="status"></span></div></figure>`
    this.part$ = selector => root.querySelector(selector)
    this.part$("form").addEventListener("submit", event => event.preventDefault())
    this.part$(".reset").addEventListener("click", () => this.reset())
    this.part$(".link").addEventListener("click", async () => { this.part$(".timing").textContent = await copyLink(this) })
    this.values = {}
    this.frame = 1
    this.hands = new Gestures(this.part$(".hands"), {
      turned: (_, moving) => this.ask(moving),
      moved: (name, value, moving) => {
        this.controls?.find(one => one.param.name === name)?.made.set(value)
        this.change(name, value, moving)
      },
      pointOf: name => [this.values[name] ?? this.job.params.find(param => param.name === name).value].flat(),
      resets: name => {
        const value = this.starts[name] ?? this.job.params.find(param => param.name === name).value
        this.controls.find(one => one.param.name === name)?.made.set(value)
        this.change(name, value, false)
      },
    })
  }

  // Starts the engine when the figure comes near the visible part of the page.
  connectedCallback() {
    this.watcher = new IntersectionObserver(entries => {
      if (!entries.some(entry => entry.isIntersecting)) return
      this.watcher.disconnect()
      this.start()
    }, { rootMargin: "200px" })
    this.watcher.observe(this)
    this.observer = new MutationObserver(records => this.noticed(records))
    this.observer.observe(this, { attributes: true })
    this.resizer = new ResizeObserver(() => {
      const { width } = this.part$(".picture").getBoundingClientRect()
      if (this.renderedWidth && Math.abs(width - this.renderedWidth) > 0.5) this.ask(false)
      this.renderedWidth = this.renderer ? width : 0
    })
    this.resizer.observe(this.part$(".picture"))
    this.followLink = () => this.job && this.takeLink()
    addEventListener("hashchange", this.followLink)
    queueMicrotask(() => this.reserve()) // the parser has added the script inside by then, if the element is written in a page
  }

  disconnectedCallback() {
    for (const one of [this.watcher, this.observer, this.resizer]) one?.disconnect()
    removeEventListener("hashchange", this.followLink)
    this.renderer?.stop()
    this.job?.close()
    this.job = null
  }

  // Makes the controls before the engine has started, if the page has the parameters. Otherwise keeps their space free, if
  // the attribute `controls` names them.
  reserve() {
    if (this.job || this.controls) return
    this.setSize()
    const inside = this.querySelector("script.params")
    const known = this.given?.params ?? (inside && JSON.parse(inside.textContent))
    if (known) return this.makeControls(known)
    const wanted = listed(this.getAttribute("controls") ?? "")
    if (wanted.length === 0) return
    this.makeControls(wanted.map(name => ({ name, type: "number", min: 0, max: 1, value: 0, doc: "\u00a0" })))
    this.controls = undefined
    this.part$("form").classList.add("waits")
  }

  async start() {
    const mine = this.starting = {}
    wait(this.part$(".wait"), Infinity)
    try {
      const [glint, source] = await Promise.all([engineOfPage(), sourceOf(this)])
      this.source = source
      const { name, text, files, values } = source
      this.renderer?.stop()
      this.job?.close()
      const job = await glint.open(text, { name, files, set: values })
      if (mine !== this.starting) return job.close()
      this.job = job
      this.frame = Math.min(Number(this.getAttribute("frame")) || 1, this.job.frames)
      this.renderer = new Renderer(this.job, {
        page: () => this.page(),
        waits: ms => wait(this.part$(".wait"), ms),
        shown: (image, how) => this.shown(image, how),
        failed: error => this.failed(error),
      })
      this.setSize()
      this.makeControls(this.job.params)
      this.makePlayer()
      this.takeAttributes()
      this.takeLink()
      this.ask(false)
    } catch (error) {
      if (mine === this.starting) this.failed(error)
    }
  }

  // Sets the size of the picture in the page, as an img has it: the attributes', otherwise the script's; limited by the
  // page's width. Before the script has run, the img inside stands for the script.
  setSize() {
    const inside = this.querySelector("img")
    const { width, height } = this.job ?? { width: Number(inside?.getAttribute("width")), height: Number(inside?.getAttribute("height")) }
    if (!this.job && !(width && height)) return
    const share = /^\s*[\d.]+%/.exec(this.getAttribute("width"))?.[0] // of the space that there is
    const [wide, high] = ["width", "height"].map(name => parseFloat(name === "width" && share ? "" : this.getAttribute(name)) || 0)
    this.wide = wide || (high ? high * width / height : width)
    this.ratio = wide && high ? wide / high : width / height
    Object.assign(this.part$("figure").style, share ? { width: share, maxWidth: "100%" } : { width: "", maxWidth: `${this.wide}px` })
    this.part$(".picture").style.aspectRatio = this.ratio
  }

  // Returns the size of the picture in the page.
  page() {
    const width = this.part$(".picture").getBoundingClientRect().width || this.wide
    return { width, height: width / this.ratio }
  }

  // ---- Parameters ----

  makeControls(params) {
    const text = this.source?.text ?? this.given?.text ?? this.querySelector('script[type="text/x-lua"]')?.textContent
    const wanted = this.hasAttribute("controls") ? listed(this.getAttribute("controls")) : ordered(params, text).map(param => param.name)
    const found = wanted.map(name => {
      const param = params.find(one => one.name === name)
      if (!param) throw new Error(`glint-figure: controls: the script has no parameter "${name}"`)
      return param
    })
    const form = this.part$("form")
    if (!this.controls || JSON.stringify(found) !== JSON.stringify(this.controls.map(one => one.written))) {
      this.controls = found.map(written => {
        const param = { ...written, start: written.value }
        return { written, param, made: control(param, (value, moving) => this.change(param.name, value, moving)) }
      })
      form.replaceChildren(...this.controls.map(one => one.made.element))
      for (const { param, made } of this.controls) if (param.name in this.values) made.set(this.values[param.name])
    }
    form.classList.remove("waits")
    form.hidden = wanted.length === 0
    this.showFoot()
  }

  showFoot() {
    const changes = this.controls?.length > 0 || this.hands.mayTurn || this.hands.handles.size > 0
    this.part$(".foot").hidden = !changes && !this.hasAttribute("timing") && !this.part$(".timing").textContent
    for (const button of [".reset", ".link"]) this.part$(button).hidden = !changes
  }

  // Called for each value that the reader chooses.
  change(name, value, moving) {
    this.fault = ""
    this.values = { ...this.values, [name]: value }
    this.reflect(name, value)
    this.dispatchEvent(new CustomEvent("value", { detail: { name, value, moving }, bubbles: true, composed: true }))
    this.ask(moving)
  }

  // Sets parameters, { name: value }, as the reader would. Sends no event.
  set(values) {
    for (const [name, value] of Object.entries(values)) {
      this.values = { ...this.values, [name]: value }
      this.controls?.find(one => one.param.name === name)?.made.set(value)
      this.reflect(name, value)
    }
    this.ask(false)
  }

  reset() {
    this.fault = ""
    this.values = { ...this.starts }
    for (const { param, made } of this.controls) made.set(param.start)
    for (const param of this.job?.params ?? []) this.reflect(param.name, this.starts?.[param.name])
    this.hands.view = { ...STILL }
    this.ask(false)
  }

  // ---- Attributes ----

  // Returns the attribute of a parameter; undefined if another parameter, whose name differs by capitals only, has it.
  attributeOf(name) {
    const isTaken = name !== name.toLowerCase() && this.job?.params.some(param => param.name !== name && param.name.toLowerCase() === name.toLowerCase())
    if (isTaken) return undefined
    return /^on/i.test(name) || OWN.includes(name.toLowerCase()) ? `set-${name}` : name
  }

  // Writes a value into its attribute; undefined removes it.
  reflect(name, value) {
    this.noticed(this.observer?.takeRecords() ?? [])
    const attribute = this.attributeOf(name)
    if (attribute === undefined) return
    try {
      if (value === undefined) this.removeAttribute(attribute)
      else this.setAttribute(attribute, spelled(value))
    } catch { /* the name cannot be an attribute */ }
    this.observer?.takeRecords()
  }

  // Takes the values that the attributes have.
  takeAttributes() {
    this.starts = {}
    for (const param of this.job.params) {
      const attribute = this.attributeOf(param.name), text = attribute === undefined ? null : this.getAttribute(attribute)
      if (text !== null && !(param.name in this.values)) this.starts[param.name] = parsed(param, text)
    }
    for (const { param, made } of this.controls) {
      if (!(param.name in this.starts)) continue
      param.start = this.starts[param.name]
      made.set(param.start)
    }
    this.values = { ...this.starts, ...this.values }
  }

  noticed(records) {
    if (!this.job || records.length === 0) return
    const names = new Set(records.map(record => record.attributeName))
    if (["src", "files", "controls"].some(name => names.has(name))) return this.restart()
    if (names.has("width") || names.has("height")) this.setSize()
    if (names.has("frame")) this.frame = Math.min(Number(this.getAttribute("frame")) || 1, this.job.frames)
    for (const param of this.job.params) {
      const attribute = this.attributeOf(param.name)
      if (!attribute || !names.has(attribute.toLowerCase())) continue
      const text = this.getAttribute(attribute)
      const { [param.name]: _, ...others } = this.values
      const value = text === null ? param.value : parsed(param, text)
      this.values = text === null ? others : { ...others, [param.name]: value }
      this.controls.find(one => one.param.name === param.name)?.made.set(value)
    }
    this.ask(false)
  }

  restart() {
    this.values = {}
    this.controls = undefined
    this.start()
  }

  // Takes what the page's address says about this figure.
  takeLink() {
    const { values, frame, orbit } = readLink(this, this.job.params)
    const faults = this.job.params.filter(param => param.name in values).map(param => [param.name, fault(param, values[param.name])]).filter(([, text]) => text)
    for (const [name] of faults) delete values[name]
    this.fault = faults.map(([, text]) => `The link has ${text}`).join("\n")
    if (frame) this.goTo(Math.min(Math.max(1, Math.round(frame)), this.job.frames), null)
    if (orbit) this.hands.view = viewOf(orbit)
    if (Object.keys(values).length > 0) this.set(values)
    else if (frame || orbit || this.fault) this.ask(false)
  }

  // ---- Frames ----

  makePlayer() {
    const { frames } = this.job
    const [bar, button, slider] = [".player", ".play", ".frames"].map(this.part$)
    bar.hidden = frames < 2
    if (frames < 2) return
    slider.max = frames
    this.player = new Player(frames, this.job.fps, frame => { this.goTo(frame, true) })
    button.onclick = () => {
      this.player.frame = this.frame
      this.player.toggle()
      button.textContent = this.player.playing ? "Pause" : "Play"
      button.setAttribute("aria-pressed", String(this.player.playing))
      if (!this.player.playing) this.ask(false)
    }
    slider.oninput = () => this.goTo(Number(slider.value), true)
    slider.onchange = () => this.goTo(Number(slider.value), false)
    this.goTo(this.frame, null)
  }

  goTo(frame, coarse) {
    this.frame = frame
    this.part$(".frames").value = frame
    this.part$(".counter").textContent = `${frame} / ${this.job.frames}`
    if (coarse !== null) this.ask(coarse)
  }

  // ---- Pictures ----

  // Returns what the next picture shows, as job.render() takes it.
  request() {
    const orbit = orbitOf(this.hands.view)
    return { frame: this.frame, set: this.values, ...orbit && { orbit } }
  }

  ask(coarse) { this.renderer?.ask(this.request(), coarse) }

  shown(image, { coarse, ms }) {
    const canvas = this.part$("canvas")
    const inside = this.querySelector("img")
    show(canvas, this.part$(".over"), image)
    canvas.setAttribute("aria-label", inside?.alt || this.getAttribute("aria-label") || "A rendered picture")
    canvas.hidden = false
    this.part$("slot").hidden = true
    this.part$("slot").style.display = "none"
    this.part$(".picture").hidden = false
    this.showFault(this.fault)
    this.part$(".hands").hidden = false
    this.hands.update(image, name => {
      const param = this.job.params.find(one => one.name === name)
      return param.label ?? name.replaceAll("_", " ")
    })
    this.showNote(image, coarse, ms)
    this.player?.shown()
    this.dispatchEvent(new CustomEvent("glint-render", { detail: { image, coarse, ms } }))
  }

  showNote(image, coarse, ms) {
    const note = this.part$(".timing")
    const hasTiming = this.hasAttribute("timing"), { samples, ownSamples } = image
    const parts = [hasTiming ? quality(image) : samples < ownSamples ? `${samples} of ${ownSamples} samples` : ""]
    if (hasTiming && !coarse) parts.push(`${Math.max(1, Math.round(ms))} ms`)
    const text = parts.filter(Boolean).join(", ")
    note.ariaBusy = String(coarse)
    note.style.visibility = text ? "" : "hidden" // a coarse picture leaves the text's space free
    if (text || !hasTiming) note.textContent = text
    this.showFoot()
  }

  showFault(text) {
    this.part$(".error").textContent = text ?? ""
    this.part$(".error").hidden = !text
  }

  failed(error) {
    const line = error.line && error.file === this.source?.name ? this.source.text.split("\n")[error.line - 1] : undefined
    wait(this.part$(".wait"), 0)
    this.part$(".picture").hidden = this.part$("canvas").hidden && !this.querySelector("img")
    this.showFault(error.message + (line?.trim() ? `\n\n${error.line} | ${line}` : ""))
    if (this.player?.playing) this.part$(".play").click()
    this.dispatchEvent(new CustomEvent("glint-error", { detail: { error } }))
  }
}

if (!customElements.get("glint-figure")) customElements.define("glint-figure", GlintFigure)
