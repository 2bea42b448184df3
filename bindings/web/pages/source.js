// The script of a figure and what it reads: from the page, from the server or from a page of glint publish.

export const listed = text => text.split(",").map(part => part.trim()).filter(Boolean)

export function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length)
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i)
  return bytes
}

// Returns the job of a page of glint publish: { name, text, files, values, params }.
export function jobOf(document) {
  const written = document.getElementById("glint-job")
  if (!written) throw new Error("glint-figure: src: expected a script or a page of glint publish, got another page")
  const { files, same, ...job } = JSON.parse(written.textContent)
  const given = Object.fromEntries(Object.entries(files).map(([file, base64]) => [file, bytesOf(base64)]))
  for (const [file, short] of Object.entries(same)) given[file] = given[short]
  return { ...job, files: given }
}

async function fetched(address, as) {
  const response = await fetch(address)
  if (!response.ok) throw new Error(`${address}: the server answers ${response.status} ${response.statusText}`)
  return as === "text" ? response.text() : new Uint8Array(await response.arrayBuffer())
}

// Returns the script of a figure with its name, its files and the values that it begins with.
export async function sourceOf(figure) {
  if (figure.given) return figure.given
  const inside = figure.querySelector('script[type="text/x-lua"]'), src = figure.getAttribute("src"), files = {}
  if (inside) return { name: inside.getAttribute("name") || src?.split("/").pop() || "figure.lua", text: inside.textContent, files }
  if (src === null) throw new Error("glint-figure: neither a src nor a <script type=\"text/x-lua\"> inside")
  const address = new URL(src, document.baseURI)
  const text = await fetched(address, "text")
  if (/^\s*<!doctype html/i.test(text)) return jobOf(new DOMParser().parseFromString(text, "text/html"))
  for (const file of listed(figure.getAttribute("files") ?? "")) files[file.split("/").pop()] = await fetched(new URL(file, address))
  return { name: address.pathname.split("/").pop(), text, files }
}
