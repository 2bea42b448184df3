// Formulas between dollar signs as MathML, with the commands of the engine's formulas (engine/figures/text/). A formula with
// anything else stays as it is typed.
import symbols from "./symbols.json"

const MATHML = "http://www.w3.org/1998/Math/MathML"
const SPACES = { ",": 3 / 18, ":": 4 / 18, ">": 4 / 18, ";": 5 / 18, "!": -3 / 18, " ": 1 / 3, quad: 1, qquad: 2 }
const ACCENTS = { hat: "^", widehat: "^", tilde: "~", widetilde: "~", dot: "\u02d9", ddot: "\u00a8", vec: "\u2192", overrightarrow: "\u2192",
  acute: "\u00b4", grave: "`", check: "\u02c7", breve: "\u02d8", bar: "\u00af", overline: "\u00af" }
const LETTERS = { mathrm: "normal", mathsf: "sans", mathit: "italic", mathbf: "bold", boldsymbol: "bold-italic", bm: "bold-italic",
  mathcal: "script", mathscr: "script", mathbb: "double" }
const FIRST = { bold: [0x1d400, 0x1d41a], "bold-italic": [0x1d468, 0x1d482], script: [0x1d49c, 0x1d4b6], double: [0x1d538, 0x1d552],
  sans: [0x1d5a0, 0x1d5ba] } // A and a in Unicode
const HOLES = { script: { B: "\u212c", E: "\u2130", F: "\u2131", H: "\u210b", I: "\u2110", L: "\u2112", M: "\u2133", R: "\u211b", e: "\u212f", g: "\u210a", o: "\u2134" },
  double: { C: "\u2102", H: "\u210d", N: "\u2115", P: "\u2119", Q: "\u211a", R: "\u211d", Z: "\u2124" } }
const TEXTS = ["text", "textrm", "mbox", "textbf", "textsf"]

function node(tag, parts = [], attributes = {}) {
  const element = document.createElementNS(MATHML, tag)
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value)
  element.append(...[parts].flat())
  return element
}

const FONTS = "'STIX Two Math', 'Cambria Math', 'Latin Modern Math', math"
const math = inner => node("math", inner, { style: `font-family: ${FONTS}` })

// How a browser without a font for mathematics sets scripts: subscripts stand on the baseline, superscripts high above it.
let setsFlat
function measure() {
  const base = node("mi", "x"), down = node("mi", "x"), probe = math(node("msub", [base, down]))
  probe.style.cssText += "; position: absolute; visibility: hidden"
  document.body.append(probe)
  setsFlat = down.getBoundingClientRect().bottom <= base.getBoundingClientRect().bottom + 1
  probe.remove()
}
const lowered = (script, by) => setsFlat ? node("mpadded", script, { voffset: `${-by}em` }) : script

// Returns a letter in one of Unicode's mathematical alphabets.
function styled(letter, style) {
  const first = FIRST[style]
  const isSmall = letter >= "a" && letter <= "z"
  if (!first || !/[A-Za-z]/.test(letter)) return letter
  return HOLES[style]?.[letter] ?? String.fromCodePoint(first[isSmall ? 1 : 0] + letter.codePointAt(0) - (isSmall ? 97 : 65))
}

class Parser {
  constructor(text) {
    this.tokens = text.match(/\\[A-Za-z]+|\\.|\d+(?:\.\d+)*|\s+|[^]/gu) ?? []
    this.at = 0
  }
  get next() { return this.tokens[this.at] }
  skip() { while (this.next?.trim() === "") this.at++ }
  take(expected) {
    if (this.next === undefined || (expected && this.next !== expected)) throw new Error("not a formula")
    return this.tokens[this.at++]
  }

  list(style, ends) {
    const parts = []
    for (this.skip(); this.next !== undefined && !ends.includes(this.next); this.skip()) parts.push(this.scripts(style))
    return parts.length === 1 ? parts[0] : node("mrow", parts)
  }

  scripts(style) {
    const base = "^_".includes(this.next) ? node("mrow") : this.atom(style)
    const found = {}
    for (this.skip(); this.next === "\\limits" || this.next === "\\nolimits"; this.skip()) this.at++
    for (; this.next === "^" || this.next === "_"; this.skip()) {
      const sign = this.take()
      if (found[sign]) throw new Error("not a formula")
      found[sign] = this.argument(style)
    }
    const { "^": up, _: down } = found
    return up && down ? node("msubsup", [base, down, up]) : up ? node("msup", [base, lowered(up, 0.1)]) : down ? node("msub", [base, lowered(down, 0.3)]) : base
  }

  argument(style) {
    this.skip()
    if (this.next === undefined || "}^_".includes(this.next)) throw new Error("not a formula")
    if (/^\d\d/.test(this.next)) this.tokens.splice(this.at, 1, this.next[0], this.next.slice(1)) // \frac12 is one half
    return this.atom(style)
  }

  group(style) {
    this.take("{")
    const inner = this.list(style, ["}"])
    this.take("}")
    return inner
  }

  // Returns the text of an argument in braces, as typed.
  raw() {
    this.skip()
    if (this.next !== "{") return this.take()
    let text = "", depth = 0
    do {
      depth += this.next === "{" ? 1 : this.next === "}" ? -1 : 0
      text += this.take()
    } while (depth > 0)
    return text.slice(1, -1)
  }

  delimiter() {
    this.skip()
    const sign = this.take()
    return sign === "." ? "" : sign[0] === "\\" ? this.symbol(sign.slice(1))[0] : sign
  }

  symbol(name) {
    const found = symbols[name]
    if (!found) throw new Error("not a formula")
    return found
  }

  atom(style) {
    if (this.next === "{") return this.group(style)
    const token = this.take()
    if (token[0] === "\\") return this.command(token.slice(1), style)
    if (/^\d/.test(token)) return node("mn", style === "bold" ? [...token].map(digit => /\d/.test(digit) ? String.fromCodePoint(0x1d7ce + Number(digit)) : digit).join("") : token)
    if (token === "~") return node("mspace", [], { width: "0.33em" })
    if (token === "'") return node("mo", "\u2032")
    if (/\p{L}/u.test(token)) return node("mi", styled(token, style), style === "normal" || style === "sans" || style === "double" || style === "bold" ? { mathvariant: "normal" } : {})
    if (/[}$#%&\\]/.test(token)) throw new Error("not a formula")
    return node("mo", token === "-" ? "\u2212" : token === "*" ? "\u2217" : token, { stretchy: "false" })
  }

  command(name, style) {
    if (name in SPACES) return node("mspace", [], { width: `${SPACES[name].toFixed(3)}em` })
    if (name === "displaystyle") return node("mrow")
    if (name in ACCENTS) return node("mover", [this.argument(style), node("mo", ACCENTS[name], { stretchy: /^(wide|over)/.test(name) })], { accent: "true" })
    if (name === "underline") return node("munder", [this.argument(style), node("mo", "_")])
    if (/^[dtc]?frac$/.test(name)) return node("mfrac", [this.argument(style), this.argument(style)])
    if (/^[dt]?binom$/.test(name)) return node("mrow", [node("mo", "("), node("mfrac", [this.argument(style), this.argument(style)], { linethickness: 0 }), node("mo", ")")])
    if (name === "sqrt") return this.root(style)
    if (name === "left") return this.fenced(style)
    if (/^(big|Big|bigg|Bigg)[lrm]?$/.test(name)) return node("mo", this.delimiter(), { minsize: "1.4em" })
    if (TEXTS.includes(name)) return node("mtext", this.raw().replaceAll(" ", "\u00a0"), name === "textbf" ? { style: "font-weight: bold" } : {})
    if (name === "operatorname") {
      if (this.next === "*") this.at++
      return node("mi", this.raw(), { mathvariant: "normal" })
    }
    if (name in LETTERS) return this.argument(LETTERS[name])
    const [text, kind] = this.symbol(name)
    if (kind === "operator" && /^[a-z]+$/.test(text)) return node("mrow", [node("mi", text, { mathvariant: "normal" }), node("mo", "\u2061")])
    return kind === "variable" ? node("mi", text) : kind === "ordinary" ? node("mi", text, { mathvariant: "normal" }) : node("mo", text)
  }

  root(style) {
    this.skip()
    if (this.next !== "[") return node("msqrt", this.argument(style))
    this.at++
    const index = this.list(style, ["]"])
    this.take("]")
    return node("mroot", [this.argument(style), index])
  }

  fenced(style) {
    const left = this.delimiter(), inner = this.list(style, ["\\right", "}"])
    this.take("\\right")
    return node("mrow", [node("mo", left, { fence: "true", stretchy: "true" }), inner, node("mo", this.delimiter(), { fence: "true", stretchy: "true" })])
  }
}

// Returns a formula as MathML; undefined if it has anything that formulas lack.
function mathOf(formula) {
  try {
    const parser = new Parser(formula)
    if (setsFlat === undefined) measure()
    return math(parser.list("", []))
  } catch {
    return undefined
  }
}

// A formula begins and ends with a dollar sign next to something, and no digit follows it. \$ is a dollar sign.
const FORMULA = /(?<!\\)\$(?! )((?:[^$\\]|\\[^])*?)(?<! )\$(?!\d)/g

// Sets the text of an element, with its formulas.
export function setText(element, text) {
  const plain = part => part.replaceAll("\\$", "$")
  const parts = []
  let end = 0
  for (const found of text.matchAll(FORMULA)) {
    parts.push(plain(text.slice(end, found.index)), mathOf(found[1]) ?? found[0])
    end = found.index + found[0].length
  }
  element.replaceChildren(...parts, plain(text.slice(end)))
}
