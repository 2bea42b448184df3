// Makes the site: the manual, the gallery and the reference as pages with search, next to the playground and the
// course.
//   node site.mjs ROOT WEB OUT
// ROOT is the source tree, WEB the result of `make web`, OUT the folder to write.
import { cpSync, mkdirSync, readFileSync, writeFileSync } from "node:fs"
import { dirname, join, posix } from "node:path"
import { Marked } from "marked"

const [root, web, out] = process.argv.slice(2)
const read = path => readFileSync(join(root, path), "utf8")

// Pages generated from the repository's texts: the file to write, the source, and the name in the navigation.
const pages = [
  { to: "learn.html", from: "bindings/docs/learn.md", title: "Learn glint" },
  { to: "how-to.html", from: "bindings/docs/how-to.md", title: "How to" },
  { to: "explain.html", from: "bindings/docs/explain.md", title: "How glint thinks" },
  { to: "manual.html", from: "bindings/README.md", title: "Manual" },
  { to: "gallery.html", from: "scripts/README.md", title: "Gallery" },
  { to: "about.html", from: "README.md", title: "About" },
  { to: "engine.html", from: "engine/README.md", title: "The engine" },
  { to: "renderer.html", from: "engine/render/README.md", title: "The renderer" },
  { to: "python.html", from: "scripts/python.md", title: "Pictures in Python" },
  { to: "particles.html", from: "scripts/particles.md", title: "Particles" },
  { to: "farms.html", from: "scripts/farm/README.md", title: "Farms" },
]

const escape = text => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;")
const plain = html => html.replace(/<[^>]*>/g, " ").replaceAll("&lt;", "<").replaceAll("&gt;", ">").replaceAll("&quot;", '"')
  .replaceAll("&#39;", "'").replaceAll("&amp;", "&").replace(/\s+/g, " ").trim()
const slug = text => text.toLowerCase().replace(/[^\p{L}\p{N} _-]/gu, "").trim().replaceAll(" ", "-")

const navigation = [["index.html", "Playground"], ["learn.html", "Learn"], ["how-to.html", "How to"], ["course.html", "Course"],
  ["manual.html", "Manual"], ["reference.html", "Reference"],
  ["gallery.html", "Gallery"], ["explain.html", "How it works"], ["about.html", "About"]]

function layout(title, body) {
  const links = navigation.map(([to, name]) => `<a href="${to}">${name}</a>`).join(" ")
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escape(title)} · glint</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="site.css">
<script type="module" src="search.js"></script>
<header class="top"><strong>glint</strong> ${links} <form role="search"><input type="search" aria-label="Search" placeholder="Search"></form></header>
<main class="page wide">
<div id="found" role="status" hidden></div>
${body}
</main>
</html>
`
}

// ---- Texts in Markdown ----

const index = [] // { page, title, heading, anchor, text }: one per section, for the search

// Returns the site's address for a link in a source file. Files that are not pages go to source/.
function target(from, link) {
  if (/^[a-z]+:|^#/.test(link)) return link
  const [path, anchor] = link.split("#")
  const file = posix.normalize(posix.join(posix.dirname(from), path))
  const page = pages.find(one => one.from === file)
  return (page ? page.to : `source/${file}`) + (anchor ? `#${anchor}` : "")
}

const copied = new Set() // files of the source tree that pages show or link to

function sections(page, title, html) {
  for (const part of html.split(/(?=<h[1-3] id=)/)) {
    const heading = part.match(/^<h[1-3] id="([^"]*)">(.*?)<\/h[1-3]>/s)
    const text = plain(part)
    if (text) index.push({ page, title, anchor: heading?.[1] ?? "", heading: heading ? plain(heading[2]) : title, text })
  }
}

function markdown({ to, from, title }) {
  const marked = new Marked({
    renderer: {
      heading({ tokens, depth }) {
        const inner = this.parser.parseInline(tokens)
        return `<h${depth} id="${slug(plain(inner))}">${inner}</h${depth}>\n`
      },
    },
    walkTokens(token) {
      if (token.type !== "link" && token.type !== "image") return
      token.href = target(from, token.href)
      if (token.href.startsWith("source/")) copied.add(token.href.slice("source/".length).split("#")[0])
    },
  })
  const html = marked.parse(read(from))
  sections(to, title, html)
  writeFileSync(join(out, to), layout(title, html))
}

// ---- The reference, from the declarations that editors read ----

// Splits text into blocks of comments and code separated by blank lines.
function blocks(text) {
  return text.split(/\n\s*\n/).map(block => block.split("\n"))
}

const inline = text => escape(text).replace(/`([^`]*)`/g, "<code>$1</code>")

function fieldRow(line, more) {
  const [, name, type, doc] = line.match(/^---@field (\S+) (.*?)(?:  (.*))?$/) ?? []
  if (!name) return ""
  return `<tr><td><code>${escape(name)}</code></td><td><code>${escape(type)}</code></td><td>${inline([doc ?? "", ...more].join(" "))}</td></tr>`
}

function block(lines) {
  const section = lines.length === 1 && lines[0].match(/^-- ---- (.*) ----$/)
  if (section) return `<h2 id="${slug(section[1])}">${escape(section[1])}</h2>`
  const docs = lines.filter(line => /^--- /.test(line)).map(line => line.slice(4))
  const at = kind => lines.filter(line => line.startsWith(`---@${kind} `)).map(line => line.slice(kind.length + 5))
  const named = lines.find(line => line.startsWith("function "))?.match(/^function (.*?) end$/)?.[1] ?? at("class")[0] ?? at("alias")[0]
  if (!named) return ""
  const rows = []
  lines.forEach((line, i) => {
    if (!line.startsWith("---@field ")) return
    const more = []
    for (let j = i + 1; j < lines.length && lines[j].startsWith("--- "); j++) more.push(lines[j].slice(4))
    rows.push(fieldRow(line, more))
  })
  const facts = [...at("param").map(text => `takes <code>${inline(text)}</code>`), ...at("return").map(text => `returns <code>${inline(text)}</code>`)]
  const own = rows.length > 0 ? docs.filter(doc => !rows.some(row => row.includes(inline(doc)))) : docs
  return `<h3 id="${slug(named)}"><code>${escape(named)}</code></h3>` + (own.length ? `<p>${inline(own.join(" "))}</p>` : "")
    + (facts.length ? `<ul>${facts.map(fact => `<li>${fact}</li>`).join("")}</ul>` : "")
    + (rows.length ? `<table><thead><tr><th>Field</th><th>Type</th><th></th></tr></thead><tbody>${rows.filter(Boolean).join("\n")}</tbody></table>` : "")
}

function reference() {
  const html = `<h1 id="reference">Reference</h1>\n${blocks(readFileSync(join(web, "../meta/glint.lua"), "utf8")).map(block).filter(Boolean).join("\n")}`
  sections("reference.html", "Reference", html)
  writeFileSync(join(out, "reference.html"), layout("Reference", html))
}

// ---- All of it ----

mkdirSync(out, { recursive: true })
cpSync(web, out, { recursive: true })
for (const page of pages) markdown(page)
reference()
for (const file of copied) {
  mkdirSync(dirname(join(out, "source", file)), { recursive: true })
  cpSync(join(root, file), join(out, "source", file), { recursive: true })
}
writeFileSync(join(out, "search.json"), JSON.stringify(index))
