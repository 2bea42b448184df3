// Lists the commands of formulas for formula.js, from the engine's table: { name: [text, kind] }.
//   node symbols.mjs engine/figures/text/symbols.c >symbols.json
import { readFileSync } from "node:fs"

const unescape = text => Buffer.from(text.replace(/\\x([0-9a-f]{2})/g, (_, code) => String.fromCharCode(parseInt(code, 16))), "latin1").toString("utf8")
const spell = text => text.includes("\\x") ? unescape(text) : JSON.parse(`"${text}"`)
const symbols = {}
const source = readFileSync(process.argv[2], "utf8")
const commands = source.slice(source.indexOf("commands[] = {"), source.indexOf("};", source.indexOf("commands[] = {")))
for (const [, macro, name, text, rest] of commands.matchAll(/(SIGN|PLAIN|VARIABLE|LARGE)\("((?:[^"\\]|\\.)*)", "((?:[^"\\]|\\.)*)"([^)]*)\)/g))
  symbols[spell(name)] = [spell(text), (/[A-Z]+$/.exec(rest)?.[0] ?? macro).toLowerCase()]
for (const [, name, text] of commands.matchAll(/\{ "(\w+)", "((?:[^"\\]|\\.)*)"/g)) symbols[name] = [spell(text), "large"]
process.stdout.write(JSON.stringify(symbols))
