// Controls for the parameters of a script: a labelled slider, list, box or field for each, with its unit, its range and
// its doc in sight.
import { setText } from "./formula.js"

const LOGARITHMIC = 100 // a slider is logarithmic if the ratio of its ends is larger
const KEY_STEPS = 100   // of the arrow keys, from one end of a slider to the other

let count = 0 // of the controls made, for their ids

export const controlStyle = `
  .control { display: grid; grid-template-columns: auto 1fr auto; gap: 0 0.5rem; align-items: center; align-content: start; min-width: 0; }
  .control .name { grid-column: 1 / 3; font-weight: 600; overflow-wrap: anywhere; touch-action: manipulation; }
  .control .value { font-variant-numeric: tabular-nums; }
  .control .value, .control input + .end { text-align: end; }
  .control .end, .control .doc { font-size: 0.8125rem; color: color-mix(in srgb, currentColor 75%, transparent); font-variant-numeric: tabular-nums; }
  .control .doc { grid-column: 1 / -1; margin: 0; overflow-wrap: anywhere; }
  .control input, .control select { box-sizing: border-box; width: 100%; min-width: 0; min-height: 2rem; margin: 0; font: inherit; }
  .control .wide { grid-column: 1 / -1; }
  .control input[type=checkbox] { width: 1.5rem; min-height: 1.5rem; justify-self: end; }
  .control .point { display: grid; grid-template-columns: repeat(3, auto minmax(0, 1fr)); gap: 0.3rem; align-items: center; }
  @media (pointer: coarse), (max-width: 30rem) {
    .control input, .control select, .control .name { min-height: 2.75rem; }
    .control .name { align-content: center; }
    .control input[type=checkbox] { appearance: none; display: grid; place-items: center; width: 2.75rem; min-height: 2.75rem; }
    .control input[type=checkbox]::before { content: ""; width: 1.4rem; height: 1.4rem; border: 2px solid currentColor; border-radius: 0.25rem; line-height: 1.3rem;
      text-align: center; font-weight: bold; }
    .control input[type=checkbox]:checked::before { content: "\\2713"; background: #1f6fd6; border-color: #1f6fd6; color: #fff; }
    .control input[type=checkbox]:focus-visible::before { outline: 2px solid; outline-offset: 2px; }
    .control input { font-size: 1rem; }
  }
`

// Returns the number with three significant digits and no trailing zeros.
export function written(value) {
  return Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(3)))
}

const make = (tag, className, text = "") => Object.assign(document.createElement(tag), { className, textContent: text })

// Returns the value of a parameter as text, as after --set NAME=.
export const spelled = value => Array.isArray(value) ? value.join(",") : String(value)

// Returns the value that a text spells. The engine refuses a text that spells none.
export function parsed(param, text) {
  if (param.type === "boolean") return text === "" ? true : text === "true" || text === "false" ? text === "true" : text
  const numbers = text.split(",").map(part => part.trim() === "" ? NaN : Number(part))
  if (param.type === "point") return numbers.length === 3 && numbers.every(Number.isFinite) ? numbers : text
  return param.type === "number" && Number.isFinite(numbers[0]) && numbers.length === 1 ? numbers[0] : text
}

// Returns what is wrong about a value that a text spelled, for the reader; undefined: nothing.
export function fault({ name, type, choices, min = -Infinity, max = Infinity, whole }, value) {
  const range = `${Number.isFinite(min) ? ` from ${written(min)}` : ""}${Number.isFinite(max) ? ` ${Number.isFinite(min) ? "to" : "up to"} ${written(max)}` : ""}`
  const [holds, expected] = choices ? [choices.includes(value), `one of ${choices.join(", ")}`]
    : type === "number" ? [typeof value === "number" && value >= min && value <= max && !(whole && value % 1), `a ${whole ? "whole " : ""}number${range}`]
    : type === "boolean" ? [typeof value === "boolean", "true or false"]
    : type === "point" ? [Array.isArray(value), "three numbers X,Y,Z"] : [true]
  return holds ? undefined : `${name} = ${spelled(value)}; expected ${expected}`
}

// Returns the parameters in the order in which the script first names them. The engine has them by the alphabet.
export function ordered(params, script = "") {
  const text = script.slice(Math.max(0, script.indexOf("params"))).replace(/--\[\[[^]*?\]\]|--.*/g, "")
  const placeOf = ({ name }) => {
    const at = text.search(new RegExp(`(?<![\\w.])${name.replace(/[^\w]/g, "\\$&")}["']?\\]?\\s*=(?!=)`))
    return at < 0 ? Infinity : at
  }
  const places = new Map(params.map(param => [param, placeOf(param)]))
  return [...params].sort((a, b) => places.get(a) - places.get(b) || 0)
}

// Makes the control of one parameter. It calls `changed(value, moving)` for each new value. A double click returns to
// `param.start`, or to the default.
export function control(param, changed) {
  const box = make("div", "control")
  const name = make("label", "name")
  setText(name, param.label ?? param.name.replaceAll("_", " "))
  const output = make("span", "value") // an <output> element would become the target of the label
  box.append(name, output)
  const read = (param.choices ? makeList : makers[param.type])(param, box)
  name.htmlFor = read.input.id = `glint-control-${++count}`
  if (param.doc) {
    const doc = make("p", "doc")
    setText(doc, param.doc)
    doc.id = `glint-doc-${count}`
    read.input.setAttribute("aria-describedby", doc.id)
    box.append(doc)
  }
  const show = value => {
    output.textContent = read.shown && typeof value === "number" ? written(value) + (param.unit ? `\u202f${param.unit}` : "") : ""
    if (!read.shown && param.unit) output.textContent = param.unit
  }
  const set = value => { // of another type, it is wrong: the engine says so
    if (typeof value === typeof param.value) read.set(value)
    show(value)
  }
  const tell = moving => {
    const value = read.value()
    if (value === undefined) return
    show(value)
    changed(value, moving)
  }
  const start = () => param.start ?? param.default ?? param.value
  box.addEventListener("input", event => tell(event.target.type === "range"))
  box.addEventListener("change", () => tell(false))
  box.addEventListener("dblclick", event => {
    if (event.target !== name && event.target !== read.input && event.target !== output) return
    set(start())
    changed(start(), false)
  })
  set(param.value)
  return { element: box, set }
}

function makeList(param, box) {
  const input = make("select", "wide")
  param.choices.forEach((choice, i) => input.add(new Option(param.names?.[i] ?? String(choice), String(choice))))
  box.append(input)
  return { input, set: value => { input.value = String(value) }, value: () => param.choices.find(choice => String(choice) === input.value) }
}

function makeSwitch(param, box) {
  const input = Object.assign(make("input", ""), { type: "checkbox" })
  box.querySelector(".value").replaceWith(input)
  return { input, set: value => { input.checked = value === true }, value: () => input.checked }
}

function makeField(param, box) {
  const input = Object.assign(make("input", "wide"), { type: "text" })
  box.append(input)
  return { input, set: value => { input.value = value }, value: () => input.value }
}

function numberField(param) {
  const input = Object.assign(make("input", ""), { type: "number", step: param.whole ? 1 : "any", inputMode: "decimal" })
  const value = () => input.value === "" || !input.validity.valid ? undefined : Number(input.value)
  return { input, value, set: to => { input.value = to } }
}

function makePoint(param, box) {
  const group = make("div", "wide point")
  group.role = "group"
  const fields = ["x", "y", "z"].map(axis => {
    const field = numberField(param)
    field.input.setAttribute("aria-label", `${param.label ?? param.name} ${axis}`)
    group.append(make("span", "end", axis), field.input)
    return field
  })
  box.append(group)
  const value = () => {
    const values = fields.map(field => field.value())
    return values.includes(undefined) ? undefined : values
  }
  return { input: fields[0].input, value, set: to => fields.forEach((field, i) => field.set(to[i])) }
}

function makeNumber(param, box) {
  if (param.min !== undefined && param.max !== undefined) return makeSlider(param, box)
  const field = numberField(param)
  field.input.className = "wide"
  box.append(field.input)
  return field
}

// Makes a slider of whole numbers, or of any; logarithmic for large ratios.
function makeSlider(param, box) {
  const isWhole = param.whole || Number.isInteger(param.value) && Number.isInteger(param.min) && Number.isInteger(param.max) && param.max - param.min > 4
  const isLogarithmic = param.min > 0 && param.max / param.min > LOGARITHMIC
  const [place, back] = isLogarithmic ? [Math.log, Math.exp] : [x => x, x => x]
  const [first, last] = [place(param.min), place(param.max)]
  const isExact = isWhole && !isLogarithmic
  const input = Object.assign(make("input", ""), { type: "range", min: first, max: last, step: isExact ? 1 : "any" })
  box.append(make("span", "end", written(param.min)), input, make("span", "end", written(param.max)))
  const limited = x => Math.min(param.max, Math.max(param.min, x))
  const value = () => {
    const exact = limited(back(Number(input.value)))
    return isWhole ? Math.round(exact) : Number(exact.toPrecision(4))
  }
  const spoken = to => input.setAttribute("aria-valuetext", written(to) + (param.unit ? ` ${param.unit}` : ""))
  input.addEventListener("input", () => spoken(value()))
  if (!isExact || last - first > KEY_STEPS) input.addEventListener("keydown", event => step(input, event, (last - first) / KEY_STEPS, isWhole && value))
  const set = to => {
    input.value = place(limited(to))
    spoken(to)
  }
  return { input, set, value, shown: true }
}

// Moves a slider by an arrow key. value: a function of the whole number that must change; otherwise false.
function step(input, event, size, value) {
  const sign = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key]
  if (!sign) return
  event.preventDefault()
  const before = value && value()
  const from = Number(input.value)
  for (let steps = 1; steps <= 2 * KEY_STEPS; steps++) {
    input.value = from + sign * size * steps
    if (!value || value() !== before) break
  }
  input.dispatchEvent(new Event("input", { bubbles: true }))
  input.dispatchEvent(new Event("change", { bubbles: true }))
}

const makers = { number: makeNumber, boolean: makeSwitch, string: makeField, point: makePoint }
