// <glint-figure>: a picture with controls, rendered in the page.
//
//   <script type="module" src="glint-figure.js"></script>
//   <glint-figure src="moving_light.lua" controls="radius,height" width="640" height="360">
//     <img src="moving_light.png" alt="Five spheres under a lamp">
//   </glint-figure>
//
// Attributes:
//   src        address of the script; without it, the text of a <script type="text/x-lua"> inside the element
//   files      addresses of the files that the script reads, separated by commas; the script uses the last part of each
//   controls   names of the script's parameters with a control, separated by commas; default: all parameters
//   width, height   size of the picture, in CSS pixels, as of an img; a narrower page makes it smaller. Default: the script's
//   frame      first frame shown, from 1
//   timing     shows how long the last full picture took
// A full picture of several samples appears in steps, with 1, 2, 4 ... samples and their estimated errors.
// A page may set `figure.given = { name, text, files, values }` instead of src and files.
// The picture inside the element is shown until the first frame is rendered, and without JavaScript. `figure.values`
// has the values of the controls. Each finished picture sends the event "glint-render" with the `detail` { image,
// coarse, ms }, and again when image.error is known. coarse: a better picture follows. An error sends "glint-error" with
// { error }.
import { load } from "./glint.mjs"
import { control } from "./controls.js"
import { quality, Renderer, show, wait } from "./renderer.js"

let engine // one for all figures of a page
const engineOfPage = () => engine ??= load()

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
  .wait { position: absolute; bottom: 0; width: 100%; height: 3px; background: #4a90d9; transform-origin: left; }
  .error { margin: 0; padding: 0.6em 0.8em; white-space: pre-wrap; overflow-wrap: anywhere; font: 0.8125rem/1.4 ui-monospace, monospace;
    background: #8b1a1a; color: #fff; }
  form { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(14rem, 100%), 1fr)); gap: 0.5rem 1.25rem; margin: 0.6rem 0; }
  label { display: grid; grid-template-columns: 1fr auto; gap: 0 0.5rem; align-items: center; }
  label > input[type=range], label > select, label > input[type=text] { grid-column: 1 / -1; width: 100%; box-sizing: border-box;
    min-height: 1.75rem; margin: 0; font: inherit; }
  .timing { flex: 1 1 20rem; font-size: 0.875rem; }
  @media (max-width: 30rem) { .timing { min-height: 2lh; } }
  .timing:empty { display: none; }
  .note { font-variant-numeric: tabular-nums; color: color-mix(in srgb, currentColor 75%, transparent); }
  .bar { display: flex; flex-wrap: wrap; gap: 0.5rem 0.75rem; align-items: center; margin: 0.5rem 0; }
  .bar input { flex: 1 1 8rem; }
  button { font: inherit; padding: 0.25rem 0.8rem; min-height: 2rem; }
`

const list = text => text.split(",").map(part => part.trim()).filter(Boolean)

async function fetched(address, as) {
  const response = await fetch(address)
  if (!response.ok) throw new Error(`${address}: the server answers ${response.status} ${response.statusText}`)
  return as === "text" ? response.text() : new Uint8Array(await response.arrayBuffer())
}

// Plays frames in order, as fast as they are rendered, and at most at the animation's frame rate.
class Player {
  constructor(frames, fps, go) {
    Object.assign(this, { frames, fps, go })
    this.frame = 1
    this.playing = false
  }

  toggle() {
    this.playing = !this.playing
    this.due = performance.now()
    if (this.playing) this.step()
  }

  step() {
    this.frame = this.frame % this.frames + 1
    this.due = Math.max(performance.now(), this.due + 1000 / this.fps)
    this.go(this.frame)
  }

  // Called when a frame is shown.
  shown() {
    clearTimeout(this.timer)
    if (this.playing) this.timer = setTimeout(() => this.playing && this.step(), Math.max(0, this.due - performance.now()))
  }
}

export class GlintFigure extends HTMLElement {
  static observedAttributes = ["src"]

  constructor() {
    super()
    const root = this.attachShadow({ mode: "open" })
    root.innerHTML = `<style>${style}</style>
      <figure><div class="picture"><slot></slot><canvas role="img" hidden></canvas>
        <div class="over" aria-hidden="true"></div><div class="wait" hidden></div></div>
      <pre class="error" role="alert" hidden></pre>
      <div class="bar player" hidden><button type="button" class="play" aria-pressed="false">Play</button>
        <input type="range" class="frames" min="1" step="1" value="1" aria-label="Frame"><span class="note counter"></span></div>
      <form hidden></form>
      <div class="bar foot" hidden><button type="button" class="reset">Reset</button><span class="note timing" role="status"></span></div></figure>`
    this.part$ = selector => root.querySelector(selector)
    this.part$("form").addEventListener("submit", event => event.preventDefault())
    this.values = {}
    this.frame = 1
  }

  // Starts the engine when the figure comes near the visible part of the page.
  connectedCallback() {
    this.watcher = new IntersectionObserver(entries => {
      if (!entries.some(entry => entry.isIntersecting)) return
      this.watcher.disconnect()
      this.start()
    }, { rootMargin: "200px" })
    this.watcher.observe(this)
    this.resizer = new ResizeObserver(() => {
      const { width } = this.part$(".picture").getBoundingClientRect()
      if (this.renderedWidth && Math.abs(width - this.renderedWidth) > 0.5) this.ask(false)
      this.renderedWidth = this.renderer ? width : 0
    })
    this.resizer.observe(this.part$(".picture"))
  }

  disconnectedCallback() {
    this.watcher?.disconnect()
    this.resizer?.disconnect()
    this.renderer?.stop()
    this.job?.close()
    this.job = null
  }

  attributeChangedCallback(_, before, now) {
    if (before !== null && before !== now && this.job) this.start()
  }

  async source() {
    if (this.given) return this.given
    if (!this.hasAttribute("src")) {
      const inside = this.querySelector('script[type="text/x-lua"]')
      if (!inside) throw new Error("glint-figure: neither a src nor a <script type=\"text/x-lua\"> inside")
      return { name: inside.getAttribute("name") || "figure.lua", text: inside.textContent, files: {} }
    }
    const address = new URL(this.getAttribute("src"), document.baseURI)
    const files = {}
    for (const file of list(this.getAttribute("files") ?? "")) files[file.split("/").pop()] = await fetched(new URL(file, address))
    return { name: address.pathname.split("/").pop(), text: await fetched(address, "text"), files }
  }

  async start() {
    try {
      const [glint, { name, text, files, values }] = await Promise.all([engineOfPage(), this.source()])
      this.renderer?.stop()
      this.job?.close()
      this.job = await glint.open(text, { name, files, set: values })
      this.frame = Math.min(Number(this.getAttribute("frame")) || 1, this.job.frames)
      this.renderer = new Renderer(this.job, {
        page: () => this.page(),
        waits: ms => wait(this.part$(".wait"), ms),
        shown: (image, how) => this.shown(image, how),
        failed: error => this.failed(error),
      })
      this.setSize()
      this.makeControls()
      this.makePlayer()
      this.ask(false)
    } catch (error) {
      this.failed(error)
    }
  }

  // Sets the size of the picture in the page, as an img has it: the attributes', otherwise the script's; limited by the
  // page's width.
  setSize() {
    const { width, height } = this.job, [wide, high] = ["width", "height"].map(name => Number(this.getAttribute(name)))
    this.wide = wide || (high ? high * width / height : width)
    this.ratio = wide && high ? wide / high : width / height
    this.part$("figure").style.maxWidth = `${this.wide}px`
    this.part$(".picture").style.aspectRatio = this.ratio
  }

  // Returns the size of the picture in the page.
  page() {
    const width = this.part$(".picture").getBoundingClientRect().width || this.wide
    return { width, height: width / this.ratio }
  }

  makeControls() {
    const wanted = this.hasAttribute("controls") ? list(this.getAttribute("controls")) : this.job.params.map(param => param.name)
    const form = this.part$("form")
    this.controls = []
    form.replaceChildren()
    for (const name of wanted) {
      const param = this.job.params.find(one => one.name === name)
      if (!param) throw new Error(`glint-figure: controls: the script has no parameter "${name}"`)
      const made = control(param, (value, moving) => {
        this.values = { ...this.values, [name]: value }
        this.ask(moving)
      })
      this.controls.push({ param, made })
      form.append(made.element)
    }
    form.hidden = wanted.length === 0
    this.part$(".foot").hidden = wanted.length === 0 && !this.hasAttribute("timing")
    this.part$(".reset").hidden = wanted.length === 0
    this.part$(".reset").onclick = () => {
      for (const { param, made } of this.controls) made.set(param.value)
      this.values = {}
      this.ask(false)
    }
  }

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

  ask(coarse) {
    this.renderer.ask({ frame: this.frame, set: this.values }, coarse)
  }

  shown(image, { coarse, ms }) {
    const canvas = this.part$("canvas")
    const inside = this.querySelector("img")
    show(canvas, this.part$(".over"), image)
    canvas.setAttribute("aria-label", inside?.alt || this.getAttribute("aria-label") || "A rendered picture")
    canvas.hidden = false
    this.part$("slot").hidden = true
    this.part$("slot").style.display = "none"
    this.part$(".error").hidden = true
    this.showNote(image, coarse, ms)
    this.player?.shown()
    this.dispatchEvent(new CustomEvent("glint-render", { detail: { image, coarse, ms } }))
  }

  showNote(image, coarse, ms) {
    const note = this.part$(".timing")
    const parts = [quality(image)]
    if (this.hasAttribute("timing") && !coarse) parts.push(`${Math.max(1, Math.round(ms))} ms`)
    const text = parts.filter(Boolean).join(", ")
    note.ariaBusy = String(coarse)
    note.style.visibility = text ? "" : "hidden" // a coarse picture leaves the text's space free
    if (text) note.textContent = text
    if (text) this.part$(".foot").hidden = false
  }

  failed(error) {
    const box = this.part$(".error")
    box.textContent = error.message
    box.hidden = false
    if (this.player?.playing) this.part$(".play").click()
    this.dispatchEvent(new CustomEvent("glint-error", { detail: { error } }))
  }
}

if (!customElements.get("glint-figure")) customElements.define("glint-figure", GlintFigure)
