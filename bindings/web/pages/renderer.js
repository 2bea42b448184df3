// Pictures of a job: in which order, in which size and with how many samples they are rendered, and how they are shown.
import { load } from "./glint.mjs"
import { written } from "./controls.js"

const REST_MS = 150         // after this time without changes the picture gets its full size and samples
const HOLD_MS = 500         // the same while the reader still holds the control
const ANSWER_MS = 40        // time for a picture while a control moves
const PIXELS_MS = 16        // of which its pixels get at least this, whatever the fixed part takes
const FIRST_SCALE = 0.25    // size of the first picture, before any cost is known
const STEP_MS = 1000        // a picture that takes longer appears in smaller sizes first
const WHOLE = 0.85          // a larger scale is rounded up to the full size
const KEEP_RATIO = 1.5      // a drag keeps the size of the drag before it unless that is wrong by this factor
const CHANGE_RATIO = 1.25   // within a drag, the size changes only if it is wrong by this factor
const CHANGE_MOST = 4       // largest factor of one change
const RECENT = 7            // number of pictures that decide about a change; also the number of measurements that count
const LATE = 1.25           // the size changes if all of them but one took more than this many times ANSWER_MS,
const EARLY = 0.5           // or less than this many times
const STUCK = 4             // it changes after two pictures if both took more than this many times ANSWER_MS; after the
                            // first change of a drag, only if all RECENT pictures did
const LEAST_WIDE = 160      // width of the smallest picture while a control moves, pixels,
const LEAST_MS = 200        // unless it takes longer than this
const FEW_RAYS = [2, 1]     // rays of each kind while a control moves, if a picture of full size takes too long with all
const CLEAR = 0.5           // the second number is used only if the scale with the first one is below this
const NUDGE = 0.01          // change of a parameter in the hidden pictures that measure a drag, as a share of its range
const WAIT_MS = 500         // shortest time that is shown as a line
const SAMPLES = 4           // fewest samples of a pixel at rest
const LETTERS = 12          // smallest size of letters, CSS pixels
const DENSITY = 2           // most pixels rendered per CSS pixel, in each direction

// Loads the engine with a font, in which the page shows the overlays, too. options: as of load; font is by default true.
export async function loadWithFont({ font = true, ...options } = {}) {
  const glint = await load({ font, ...options })
  if (glint.font) document.fonts.add(await new FontFace("DejaVu Sans", glint.font).load())
  return glint
}

// Returns the picture's samples and error as text; "" for a scene of one sample.
export function quality({ samples, ownSamples, error, trusted }) {
  const estimate = error === undefined ? "" : `, estimated error ${written(error)}${trusted ? "" : " (not to be trusted)"}`
  return ownSamples > 1 ? `${samples} of ${ownSamples} samples${estimate}` : ""
}

// Draws the picture's 8-bit values on a canvas, and its overlays in the element over the canvas. Their sizes in the page
// do not change.
export function show(canvas, over, image) {
  if (canvas.width !== image.width || canvas.height !== image.height) {
    canvas.width = image.width
    canvas.height = image.height
  }
  canvas.getContext("2d").putImageData(new ImageData(image.rgba, image.width, image.height), 0, 0)
  if (over.shown !== image.marks) over.innerHTML = image.marks
  over.shown = image.marks
}

// Shows in a line how much of a time has passed. ms: the expected time; a short one is not shown. Infinity: it is unknown, and
// the line appears when it is no longer short.
export function wait(line, ms) {
  line.hidden = ms < WAIT_MS
  line.getAnimations().forEach(one => one.cancel())
  if (ms === Infinity) line.animate([{ transform: "scaleX(0)" }, { transform: "none" }], { duration: 1000, delay: WAIT_MS, fill: "backwards", iterations: Infinity, direction: "alternate" })
  else if (!line.hidden) line.animate([{ transform: "scaleX(0)" }, { transform: "scaleX(0.95)" }], { duration: Math.min(ms, 1e7), easing: "ease-out", fill: "forwards" })
}

// Returns the second shortest time, or the shorter of two. Other work of the machine slows some pictures down.
const usual = list => [...list].sort((a, b) => a - b)[Math.min(1, list.length - 1 >> 1)]

// The cost of a picture: a fixed part, which has the script, the overlays and the page, and a part for each sample.
export class Cost {
  #fixed = []
  #sample = []
  #isCold = true

  // Takes a picture that took `ms`, of which the engine needed `pixelMs` for its samples. isCold: it has little to reuse.
  // Cold pictures count only until a warm one is added.
  add({ ms, pixelMs, samples, isCold = false }) {
    if (isCold && !this.#isCold) return
    if (this.#isCold && !isCold) this.#fixed = this.#sample = []
    this.#isCold = isCold
    this.#fixed = [...this.#fixed, Math.max(0, ms - pixelMs)].slice(-RECENT)
    this.#sample = [...this.#sample, pixelMs / samples].slice(-RECENT)
  }

  get isKnown() { return this.#sample.length > 0 }
  // Returns the expected time of a picture; ms.
  of(samples) { return this.isKnown ? usual(this.#fixed) + samples * usual(this.#sample) : Infinity }
  // Returns the number of samples for which there is time.
  samplesIn(ms) { return Math.max(ms - usual(this.#fixed), PIXELS_MS) / Math.max(usual(this.#sample), 1e-9) }
}

// Returns values that differ a little from a request's, as if the reader moved the first control that has a range.
// undefined: there is none.
function nudged(params, { set }, count) {
  const param = params?.find(({ type, choices, min, max }) => type === "number" && !choices && max > min)
  if (!param) return undefined
  const { name, min, max, whole } = param, value = set[name] ?? param.value, by = count * (whole ? 1 : NUDGE * (max - min))
  return { ...set, [name]: value + by <= max ? value + by : Math.max(min, value - by) }
}

// Renders a job's pictures as the controls request them: one at a time, the newest request first. Each change is
// answered by a picture of the best size for which there is time. If there is no time for all rays, a sample sends at most
// one or two of each kind. A drag, a series of changes without a rest, keeps the size of the drag before it, or changes it
// once as a rule. At rest the picture gets its full size, in device pixels, and its samples, in steps; a change ends them. Another
// job renders these pictures, so that the first one keeps what a drag can reuse.
//   page      returns the size of the picture in the page, CSS pixels: { width, height }
//   size      returns the picture's own size if it may differ: a page that is too narrow shows it smaller
//   density   returns the device's pixels per CSS pixel
//   shown     takes (image, { coarse, ms }). coarse: a better picture follows
//   waits     takes the time that the next picture is expected to take, ms; 0: it is there
//   failed    takes an error
export class Renderer {
  constructor(job, { page, size = page, density = () => globalThis.devicePixelRatio ?? 1, shown, failed, waits = () => {}, clock = performance }) {
    Object.assign(this, { job, page, size, density, shown, failed, waits, clock })
    this.cost = new Cost() // of pictures at rest
    this.moving = new Cost() // of pictures while a control moves
    this.running = false
    this.next = null
    this.drag = null // { scale, count, changes, times, cost }; count: pictures so far, 0 for the first picture of all
    this.scale = 0 // of the last picture of a drag
    this.isMeasured = false // `moving` has the pictures of a drag
    this.rays = {} // the limit of rays while a control moves, as an option of job.render()
    this.second = null // a promise of another job of the script, for the pictures at rest
  }

  // isHeld: the reader holds a control, and more changes may follow.
  ask(request, isHeld = false) {
    this.next = request
    this.isHeld = isHeld
    this.wake?.()
    this.abort?.abort()
    if (!this.running) this.run()
  }

  stop() {
    this.next = null
    this.wake?.()
    this.abort?.abort()
    this.#closeSecond()
  }

  // Returns the size of a picture and of its overlays.
  #sizes(scale) {
    const page = this.page(), { width, height } = this.size(), factor = Math.min(DENSITY, this.density()) * scale
    const whole = side => Math.max(1, Math.round(side))
    return {
      width: Math.max(16, whole(width * factor)), height: Math.max(9, whole(height * factor)),
      layers: { width: whole(page.width), height: whole(page.height), least: LETTERS },
    }
  }

  // Returns the scale at which a picture takes ANSWER_MS; a small picture may take longer.
  #answerScale(cost = this.moving.isKnown ? this.moving : this.cost) {
    if (!cost.isKnown) return FIRST_SCALE
    const { width, height } = this.#sizes(1), scaleIn = ms => Math.sqrt(cost.samplesIn(ms) / (width * height))
    const scale = Math.max(scaleIn(ANSWER_MS), Math.min(LEAST_WIDE / width, scaleIn(LEAST_MS)))
    return scale > WHOLE ? 1 : scale
  }

  // Returns the scale of a drag's first picture: the scale of the last picture, whose results can be reused, if it is about right.
  #firstScale(ratio) {
    const scale = this.#answerScale(), better = scale / this.scale
    return Math.max(better, 1 / better) < ratio ? this.scale : scale
  }

  async run() {
    this.running = true
    while (this.next) {
      const request = this.next
      this.next = null
      try {
        await this.#answer(request)
        if (!this.next) await this.#rest()
        if (!this.next) await this.#fill(request)
        if (!this.next && !this.isMeasured && this.job.params?.length > 0) await this.#prepare(request)
      } catch (error) {
        if (error.name !== "AbortError") this.failed(error)
      }
      this.waits(0)
    }
    this.running = false
  }

  // Waits for REST_MS or HOLD_MS, or until there is another request. The first picture does not wait.
  #rest() {
    if (!this.drag.count) return
    return new Promise(done => {
      const timer = setTimeout(done, this.isHeld ? HOLD_MS : REST_MS)
      this.wake = () => { clearTimeout(timer); done() }
    })
  }

  // Shows a picture of the drag's size.
  async #answer(request) {
    const isFirst = !this.cost.isKnown
    if (!isFirst && !this.moving.isKnown && this.#answerScale() < 1) this.rays = { rays: FEW_RAYS[0] }
    const drag = this.drag ??= { scale: this.#firstScale(KEEP_RATIO), count: 0, changes: 0, times: [], cost: new Cost() }
    if (!isFirst) drag.count++
    const ms = isFirst ? await this.#picture(this.job, request, drag.scale, this.cost)
      : await this.#picture(this.job, { ...request, ...this.rays }, drag.scale, this.moving, { isCold: drag.count === 1 })
    this.scale = drag.scale
    this.isMeasured ||= drag.count > 2
    drag.times = [...drag.times, ms].slice(-RECENT)
    if (!this.#isOff(drag)) return
    const better = this.#answerScale(drag.cost.isKnown ? drag.cost : undefined) / drag.scale
    if (Math.max(better, 1 / better) < CHANGE_RATIO) return
    drag.scale *= Math.min(CHANGE_MOST, Math.max(better, 1 / CHANGE_MOST))
    drag.changes++
    drag.times = []
    drag.cost = new Cost()
  }

  // Returns whether a drag's pictures took so long, or so little time, that they should have another size.
  #isOff({ scale, changes, times }) {
    const time = this.#sizes(scale).width > LEAST_WIDE ? ANSWER_MS : LEAST_MS
    const all = [...times].sort((a, b) => a - b), isFull = all.length === RECENT
    if (changes) return isFull && all[0] > STUCK * time
    return all.length > 1 && all[0] > STUCK * time || isFull && (all[1] > LATE * time || all[RECENT - 2] < EARLY * time && scale < 1)
  }

  // Renders hidden pictures as in a drag, and measures them. The first drag then begins with the right size and number of
  // rays, and can reuse rays of that size.
  async #prepare(request) {
    const abort = this.abort = new AbortController(), { params } = this.job
    let count = 0
    const render = async isCold => {
      this.scale = this.#firstScale(CHANGE_RATIO)
      const since = this.clock.now(), set = nudged(params, request, count++) ?? request.set
      const image = await this.job.render({ ...request, set, ...this.rays, ...this.#sizes(this.scale), samples: 1, signal: abort.signal })
      this.moving.add({ ms: this.clock.now() - since, pixelMs: image.pixelMs, samples: image.width * image.height, isCold })
    }
    this.rays = {}
    this.moving = new Cost()
    await render(true)
    this.isMeasured = true
    if (!nudged(params, request, 0)) return
    await render(false)
    for (const rays of FEW_RAYS) {
      if (this.#answerScale() >= (this.rays.rays ? CLEAR : 1)) break
      this.rays = { rays }
      this.moving = new Cost()
      for (let i = 0; i < 2; i++) await render(false)
    }
    for (let i = 0; i < 4 && this.#firstScale(CHANGE_RATIO) !== this.scale; i++) await render(false) // larger pictures cost less per sample
  }

  // Renders and shows a picture of one sample a pixel. Returns its time. A picture of the same values as the one before it
  // is reused and costs nothing, so it does not count.
  async #picture(job, request, scale, cost, { isCold, signal } = {}) {
    const since = this.clock.now(), sizes = this.#sizes(scale), values = JSON.stringify(request), repeats = values === this.values
    const image = await job.render({ ...request, ...sizes, samples: 1, signal })
    this.values = values
    this.shown(image, { coarse: true, ms: this.clock.now() - since })
    const ms = this.clock.now() - since
    const taken = { ms, pixelMs: image.pixelMs, samples: image.width * image.height, isCold: isCold && image.casts !== 0 }
    if (!repeats || cost === this.cost) for (const one of [cost, ...this.drag?.count ? [this.drag.cost] : []]) one.add(taken)
    return ms
  }

  // Shows the picture of full size and samples.
  async #fill(request) {
    const sizes = this.#sizes(1), pixels = sizes.width * sizes.height, least = this.job.samples < SAMPLES ? { samples: SAMPLES } : {}
    const one = this.cost.of(pixels)
    const abort = this.abort = new AbortController()
    try {
      const job = this.drag.count ? await (this.second ??= this.job.another()) : this.job
      let { scale } = this.drag
      for (scale *= 2; scale < 0.75 && one > STEP_MS && !this.next; scale *= 2) {
        this.waits(this.cost.of(pixels * scale * scale))
        await this.#picture(job, request, scale, this.cost, { signal: abort.signal })
      }
      this.drag = null
      if (this.next) return
      let since = this.clock.now(), ms
      this.waits(one)
      for await (const image of job.steps({ ...request, ...sizes, ...least, signal: abort.signal })) {
        if (image.error === undefined) {
          ms = this.clock.now() - since
          this.cost.add({ ms, pixelMs: image.pixelMs, samples: pixels * image.samples })
        }
        const isLast = image.samples >= image.ownSamples
        this.shown(image, { coarse: !isLast, ms })
        if (this.next) return
        this.waits(isLast ? 0 : this.cost.of(pixels * Math.min(2 * image.samples, image.ownSamples)))
        since = this.clock.now()
      }
    } finally {
      this.drag = null
      this.abort = null
      if (abort.signal.aborted) this.#closeSecond()
    }
  }

  #closeSecond() {
    this.second?.then(job => job.close(), () => {})
    this.second = null
  }
}
