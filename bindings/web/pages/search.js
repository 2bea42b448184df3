// Searches the site's pages: lists the sections that contain all words, those with a word in their heading first.
const input = document.querySelector('[role="search"] input')
const found = document.getElementById("found")
const SHOWN = 12
let index

// Returns how well a section matches: 0 if a word is missing.
export function score({ heading, text }, words) {
  const [title, body] = [heading.toLowerCase(), text.toLowerCase()]
  let points = 0
  for (const word of words) {
    const times = body.split(word).length - 1
    if (times === 0 && !title.includes(word)) return 0
    points += Math.min(times, 5) + (title.includes(word) ? 20 : 0)
  }
  return points
}

function excerpt(text, word) {
  const at = Math.max(0, text.toLowerCase().indexOf(word) - 60)
  return (at > 0 ? "… " : "") + text.slice(at, at + 180) + (at + 180 < text.length ? " …" : "")
}

function result(section, words) {
  const entry = document.createElement("p")
  const link = document.createElement("a")
  link.href = `${section.page}#${section.anchor}`
  link.textContent = section.heading === section.title ? section.title : `${section.title}: ${section.heading}`
  link.addEventListener("click", () => { found.hidden = true })
  entry.append(link, document.createElement("br"), excerpt(section.text, words[0]))
  return entry
}

async function search() {
  const words = input.value.toLowerCase().split(/\s+/).filter(word => word.length > 1)
  found.hidden = words.length === 0
  if (words.length === 0) return
  index ??= await (await fetch("search.json")).json()
  const best = index.map(section => [score(section, words), section]).filter(([points]) => points > 0).sort(([a], [b]) => b - a)
  found.replaceChildren(...best.slice(0, SHOWN).map(([, section]) => result(section, words)))
  if (best.length === 0) found.textContent = `Nothing has all of: ${words.join(" ")}`
}

input.addEventListener("input", search)
input.form.addEventListener("submit", event => event.preventDefault())
