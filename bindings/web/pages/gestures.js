// Hands in a picture: dragging turns the view, two fingers shift and zoom it, and handles move points. The arrow keys do
// the same.
const TURN = 180          // degrees of a drag across the picture
const KEY_TURN = 5        // degrees of an arrow key
const KEY_MOVE = 0.01     // widths of an arrow key
const ZOOM = [0.1, 10]
const SLOP = 4            // CSS pixels that a finger moves before the view turns

export const STILL = { yaw: 0, pitch: 0, zoom: 1, right: 0, up: 0 }

export const gestureStyle = `
  .hands { position: absolute; inset: 0; overflow: hidden; pointer-events: none; }
  .hands.turns { pointer-events: auto; cursor: grab; touch-action: pan-y; user-select: none; -webkit-user-select: none; }
  .hands.turns:active { cursor: grabbing; }
  .handle { position: absolute; width: 2.75rem; height: 2.75rem; min-height: 0; margin: -1.375rem; padding: 0; border: 0; background: none;
    pointer-events: auto; cursor: move; touch-action: none; }
  .handle::before { content: ""; position: absolute; inset: 0.875rem; border: 2px solid #fff; border-radius: 50%; background: #1f6fd680;
    box-shadow: 0 0 0 1.5px #0009; }
  .handle:hover::before, .handle:focus-visible::before { inset: 0.75rem; }
`

const limited = (x, [low, high]) => Math.min(high, Math.max(low, x))
const rounded = x => Math.round(x * 1000) / 1000

// Returns the view as the option `orbit` has it; undefined: it is as the script has it.
export function orbitOf(view) {
  const numbers = Object.keys(STILL).map(name => view[name])
  return numbers.every((number, i) => number === Object.values(STILL)[i]) ? undefined : numbers
}

// Returns the view that `orbitOf` has given as numbers or as text.
export function viewOf(text) {
  const numbers = String(text).split(",").map(Number)
  return Object.fromEntries(Object.keys(STILL).map((name, i) => [name, Number.isFinite(numbers[i]) ? numbers[i] : STILL[name]]))
}

export class Gestures {
  // layer: an element over the picture. turned(view, moving) and moved(name, point, moving) are called for each change,
  // resets(name) for a point that returns to its default; pointOf(name) returns a point.
  constructor(layer, { turned, moved, pointOf, resets }) {
    Object.assign(this, { layer, turned, moved, pointOf, resets })
    this.view = { ...STILL }
    this.pointers = new Map()
    this.handles = new Map()
    const on = (name, act, options) => layer.addEventListener(name, event => act.call(this, event), options)
    on("pointerdown", this.press)
    on("pointermove", this.drag)
    on("pointerup", this.release)
    on("pointercancel", this.release)
    on("contextmenu", event => this.mayTurn && event.preventDefault()) // the right button shifts the view
    on("keydown", this.key)
    on("wheel", this.wheel, { passive: false })
    on("dblclick", event => event.target.dataset?.name ? this.resets(event.target.dataset.name) : this.mayTurn && this.turn({ ...STILL }, false))
    on("touchstart", event => event.touches.length > 1 && this.mayTurn && event.cancelable && event.preventDefault(), { passive: false })
  }

  // Shows what the reader may do in a picture: handles as the engine gives them, with their labels.
  update({ orbit, handles }, labelOf) {
    this.mayTurn = Boolean(orbit)
    this.layer.classList.toggle("turns", this.mayTurn)
    if (this.mayTurn) {
      this.layer.tabIndex = 0
      this.layer.role = "application"
      this.layer.ariaLabel = "View: drag or use the arrow keys to turn it, + and - to zoom"
    }
    for (const [name, { button }] of this.handles) if (!handles.some(handle => handle.name === name)) this.drop(name, button)
    for (const handle of handles) this.place(handle, labelOf(handle.name))
  }

  drop(name, button) {
    button.remove()
    this.handles.delete(name)
  }

  place(handle, label) {
    const button = this.handles.get(handle.name)?.button ?? document.createElement("button")
    this.handles.set(handle.name, { ...handle, button })
    if (!button.isConnected) {
      Object.assign(button, { type: "button", className: "handle", ariaLabel: `${label}: drag or use the arrow keys to move it`, title: label })
      button.dataset.name = handle.name
      this.layer.append(button)
    }
    if (this.held !== handle.name) this.put(button, handle.x, handle.y)
  }

  // The handle of a point outside the picture is at its edge.
  put(button, x, y) {
    const [left, top] = [x, y].map(part => `${100 * limited(part, [0.02, 0.98])}%`)
    Object.assign(button.style, { left, top })
  }

  turn(view, moving) {
    this.view = Object.fromEntries(Object.entries({ ...view, zoom: limited(view.zoom, ZOOM) }).map(([name, x]) => [name, rounded(x)]))
    this.turned(this.view, moving)
  }

  // ---- Points ----

  // Moves a point by fractions of the picture's width and height.
  move({ name, right, down, button, x, y }, from, across, along, moving) {
    const decimals = Math.max(0, 3 - Math.floor(Math.log10(Math.hypot(...right))))
    this.moved(name, from.map((one, i) => Number((one + across * right[i] + along * down[i]).toFixed(Math.min(decimals, 12)))), moving)
    this.put(button, x + across, y + along)
  }

  // ---- Pointers ----

  press(event) {
    if (event.button > 0 && !this.mayTurn) return
    const name = event.target.dataset?.name
    const handle = name && this.handles.get(name)
    if (!handle && !this.mayTurn) return
    event.target.setPointerCapture(event.pointerId)
    const at = { x: event.clientX, y: event.clientY }
    this.pointers.set(event.pointerId, { ...at, first: at, view: this.view, shifts: event.shiftKey || event.button > 0, waits: event.pointerType === "touch" && !handle,
      handle: handle && { ...handle, from: this.pointOf(name) } })
    if (handle) this.held = name
  }

  drag(event) {
    const pointer = this.pointers.get(event.pointerId)
    if (!pointer) return
    // A finger that moves up or down scrolls the page.
    const aside = Math.abs(event.clientX - pointer.first.x), along = Math.abs(event.clientY - pointer.first.y)
    if (pointer.waits && this.pointers.size === 1 && (Math.hypot(aside, along) < SLOP || along > aside)) return
    pointer.waits = false
    const { width, height } = this.layer.getBoundingClientRect()
    if (pointer.handle) {
      pointer.last = [(event.clientX - pointer.first.x) / width, (event.clientY - pointer.first.y) / height]
      return this.move(pointer.handle, pointer.handle.from, ...pointer.last, true)
    }
    const before = this.spread()
    Object.assign(pointer, { x: event.clientX, y: event.clientY })
    const after = this.spread(), dx = after.x - before.x, dy = after.y - before.y, view = { ...this.view }
    if (this.pointers.size > 1 || pointer.shifts) {
      view.zoom *= before.distance > 0 ? after.distance / before.distance : 1
      view.right += dx / height
      view.up -= dy / height
    } else {
      view.yaw -= TURN * dx / width
      view.pitch = limited(view.pitch + TURN * dy / height, [-TURN, TURN])
    }
    this.turn(view, true)
  }

  // Returns the middle of the pointers, and how far they are apart.
  spread() {
    const all = [...this.pointers.values()].filter(pointer => !pointer.handle)
    const [x, y] = ["x", "y"].map(axis => all.reduce((sum, pointer) => sum + pointer[axis], 0) / all.length)
    return { x, y, distance: all.length > 1 ? Math.hypot(all[0].x - all[1].x, all[0].y - all[1].y) : 0 }
  }

  release(event) {
    const pointer = this.pointers.get(event.pointerId)
    if (!this.pointers.delete(event.pointerId)) return
    if (pointer.handle) this.held = undefined
    if (event.type === "pointercancel" && !pointer.handle) return pointer.waits || this.turn(pointer.view, false)
    if (pointer.handle && pointer.last) this.move(pointer.handle, pointer.handle.from, ...pointer.last, false)
    else if (!pointer.handle && !pointer.waits && this.pointers.size === 0) this.turn(this.view, false)
  }

  // A wheel with Ctrl, which is also what the pinch of a touchpad sends, zooms. Otherwise the page scrolls.
  wheel(event) {
    if (!this.mayTurn || !(event.ctrlKey || event.metaKey)) return
    event.preventDefault()
    this.turn({ ...this.view, zoom: this.view.zoom * Math.exp(-event.deltaY / 100) }, true)
  }

  // ---- Keys ----

  key(event) {
    const [dx, dy] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key] ?? [0, 0]
    const handle = this.handles.get(event.target.dataset?.name)
    const zoom = { "+": 1.1, "=": 1.1, "-": 1 / 1.1 }[event.key]
    if (handle && (dx || dy)) this.move(handle, this.pointOf(handle.name), (event.shiftKey ? 10 : 1) * KEY_MOVE * dx, (event.shiftKey ? 10 : 1) * KEY_MOVE * dy, false)
    else if (!handle && this.mayTurn && (dx || dy)) this.turn({ ...this.view, yaw: this.view.yaw + KEY_TURN * dx, pitch: limited(this.view.pitch - KEY_TURN * dy, [-TURN, TURN]) }, true)
    else if (!handle && this.mayTurn && zoom) this.turn({ ...this.view, zoom: this.view.zoom * zoom }, true)
    else return
    event.preventDefault()
  }
}
