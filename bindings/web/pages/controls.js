// Controls for the parameters of a script: a labelled slider, list, box or field for each.

const LOGARITHMIC = 100     // a slider is logarithmic if the ratio of its ends is larger

// Returns the number with three significant digits and no trailing zeros.
export function written(value) {
  return Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(3)))
}

// Makes the control of one parameter: a labelled slider, list, box or field. It calls `changed(value, moving)` for each
// new value.
export function control(param, changed) {
  const label = document.createElement("label")
  const name = document.createElement("span")
  name.textContent = param.name.replaceAll("_", " ")
  if (param.doc) label.title = param.doc
  const output = document.createElement("span") // an <output> element would become the target of the label
  output.className = "note"
  const read = makeInput(param, label)
  const { input } = read
  label.prepend(name)
  const tell = moving => {
    const value = read.value()
    if (value === undefined) return
    output.textContent = read.shown ? written(value) : ""
    changed(value, moving)
  }
  if (read.shown) name.after(output)
  output.textContent = read.shown ? written(param.value) : ""
  input.addEventListener("input", () => tell(input.type === "range"))
  input.addEventListener("change", () => tell(false))
  return {
    element: label,
    set(value) {
      read.set(value)
      output.textContent = read.shown ? written(value) : ""
    },
  }
}

function makeInput(param, label) {
  const input = document.createElement(param.choices ? "select" : "input")
  label.append(input)
  if (param.choices) {
    for (const choice of param.choices) input.add(new Option(String(choice), String(choice)))
    const set = value => { input.value = String(value) }
    set(param.value)
    return { input, set, value: () => param.choices.find(choice => String(choice) === input.value) }
  }
  if (param.type === "boolean") {
    input.type = "checkbox"
    input.checked = param.value
    return { input, set: value => { input.checked = value }, value: () => input.checked }
  }
  if (param.type === "number" && param.min !== undefined && param.max !== undefined) return makeSlider(param, input)
  input.type = param.type === "number" ? "number" : "text"
  if (param.type === "number") input.step = param.whole ? 1 : "any"
  input.value = param.value
  const number = () => input.value === "" || !input.validity.valid ? undefined : Number(input.value)
  return { input, set: value => { input.value = value }, value: param.type === "number" ? number : () => input.value }
}

// Makes a slider of 1000 steps, or of whole numbers if the range has few; logarithmic for large ratios.
function makeSlider(param, input) {
  const whole = param.whole || Number.isInteger(param.value) && Number.isInteger(param.min) && Number.isInteger(param.max) && param.max - param.min > 4
  const logarithmic = param.min > 0 && param.max / param.min > LOGARITHMIC
  input.type = "range"
  const place = logarithmic ? Math.log : x => x
  const back = logarithmic ? Math.exp : x => x
  input.min = place(param.min)
  input.max = place(param.max)
  input.step = whole && !logarithmic ? 1 : (place(param.max) - place(param.min)) / 1000
  const limited = x => Math.min(param.max, Math.max(param.min, x))
  const value = () => {
    const exact = limited(back(Number(input.value)))
    return whole ? Math.round(exact) : Number(exact.toPrecision(4))
  }
  const spoken = () => input.setAttribute("aria-valuetext", written(value()))
  const set = to => {
    input.value = place(limited(to))
    input.setAttribute("aria-valuetext", written(to))
  }
  input.addEventListener("input", spoken)
  set(param.value)
  return { input, set, value, shown: true }
}
