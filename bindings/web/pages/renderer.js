// Pictures of a job: the order in which they are rendered, and how they are shown.
import { written } from "./controls.js"

const REST_MS = 150         // after this time without changes the full picture is rendered
const COARSE_MS = 30        // time limit for a picture while a control moves

// Returns the picture's samples and error as text; "" for a scene of one sample.
export function quality({ samples, ownSamples, error, trusted }) {
  const estimate = error === undefined ? "" : `, estimated error ${written(error)}${trusted ? "" : " (not to be trusted)"}`
  return ownSamples > 1 ? `${samples} of ${ownSamples} samples${estimate}` : ""
}

// Draws the picture's 8-bit values on a canvas, whose size in the page does not change.
export function show(canvas, image) {
  if (canvas.width !== image.width || canvas.height !== image.height) {
    canvas.width = image.width
    canvas.height = image.height
  }
  canvas.getContext("2d").putImageData(new ImageData(image.rgba, image.width, image.height), 0, 0)
}

// Renders a job's pictures as the controls request them: one at a time, the newest request first, coarse while a
// control moves, otherwise in steps. A request cancels the steps of the one before.
export class Renderer {
  constructor(job, { size, shown, failed }) {
    Object.assign(this, { job, size, shown, failed })
    this.scale = 0.5
    this.running = false
    this.next = null
  }

  // Requests a picture. After a coarse picture the full one follows, when there has been no request for a moment.
  ask(request, coarse = false) {
    clearTimeout(this.rest)
    if (coarse) this.rest = setTimeout(() => this.ask(request), REST_MS)
    this.next = { request, coarse }
    this.abort?.abort()
    if (!this.running) this.run()
  }

  stop() {
    clearTimeout(this.rest)
    this.next = null
    this.abort?.abort()
  }

  async run() {
    this.running = true
    while (this.next) {
      const { request, coarse } = this.next
      this.next = null
      await this.render(request, coarse)
    }
    this.running = false
  }

  async render(request, coarse) {
    const { width, height } = this.size()
    const scale = coarse ? this.scale : 1
    const small = { width: Math.max(16, Math.round(width * scale)), height: Math.max(9, Math.round(height * scale)) }
    const abort = coarse ? null : new AbortController()
    this.abort = abort
    try {
      const pictures = coarse ? [this.job.render({ ...request, ...small, samples: 1 })] : this.job.steps({ ...request, ...small, signal: abort.signal })
      let since = performance.now(), ms
      for await (const image of pictures) {
        if (image.error === undefined) ms = performance.now() - since
        if (coarse) this.scale = Math.min(1, Math.max(0.125, scale * Math.sqrt(COARSE_MS / Math.max(ms, 1))))
        this.shown(image, { coarse: coarse || image.samples < image.ownSamples, ms })
        since = performance.now()
      }
    } catch (error) {
      if (error.name !== "AbortError") this.failed(error)
    }
    this.abort = null
  }
}
