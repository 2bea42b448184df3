// The values of figures in the address of their page: #n=32&frame=3&orbit=30,10. If the page has several figures, each
// name begins with the figure's id or number and a point: #2.n=32.
import { parsed, spelled } from "./controls.js"
import { orbitOf } from "./gestures.js"

function prefixOf(figure) {
  const all = [...document.querySelectorAll("glint-figure")]
  return all.length > 1 ? `${figure.id || all.indexOf(figure) + 1}.` : ""
}

// Returns what the address says about a figure. Names that are no parameters are ignored.
export function readLink(figure, params) {
  const prefix = prefixOf(figure), values = {}
  const named = new URLSearchParams(location.hash.slice(1))
  for (const param of params) {
    const text = named.get(`${prefix}set-${param.name}`) ?? (["frame", "orbit"].includes(param.name) ? null : named.get(prefix + param.name))
    if (text !== null) values[param.name] = parsed(param, text)
  }
  return { values, frame: Number(named.get(`${prefix}frame`)) || undefined, orbit: named.get(`${prefix}orbit`) ?? undefined }
}

// Writes the values of a figure into the address and copies the address. Returns what has happened, for the reader.
export async function copyLink(figure) {
  const prefix = prefixOf(figure)
  const named = new URLSearchParams(location.hash.slice(1))
  for (const name of [...named.keys()]) if (name.startsWith(prefix)) named.delete(name)
  for (const [name, value] of Object.entries(figure.values)) named.set(prefix + (["frame", "orbit"].includes(name) ? `set-${name}` : name), spelled(value))
  if (figure.job?.frames > 1) named.set(`${prefix}frame`, figure.frame)
  const orbit = orbitOf(figure.hands.view)
  if (orbit) named.set(`${prefix}orbit`, orbit)
  history.replaceState(null, "", `#${named.toString().replaceAll("%2C", ",")}`)
  try {
    await navigator.clipboard.writeText(location.href)
    return "link copied"
  } catch {
    return "the link is in the address bar"
  }
}
