// The editor of the playground. It is larger than the rest of the page, which loads it after the first picture.
import { basicSetup, EditorView } from "codemirror"
import { keymap } from "@codemirror/view"
import { indentWithTab } from "@codemirror/commands"
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language"
import { lua } from "@codemirror/legacy-modes/mode/lua"
import { setDiagnostics } from "@codemirror/lint"
import { tags } from "@lezer/highlight"

const theme = EditorView.theme({
  "&": { color: "var(--text)", backgroundColor: "var(--paper)" },
  ".cm-content": { caretColor: "var(--text)" },
  ".cm-gutters": { backgroundColor: "var(--panel)", color: "var(--quiet)", border: "0" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "color-mix(in srgb, var(--accent) 8%, transparent)" },
})
const colors = HighlightStyle.define([
  { tag: tags.comment, color: "var(--quiet)" },
  { tag: tags.keyword, color: "var(--keyword)" },
  { tag: [tags.string, tags.number, tags.atom], color: "var(--value)" },
])

export class Editor {
  #view
  // Replaces the contents of an element by an editor with this text. `changed` is called after each change.
  constructor(element, text, changed) {
    this.#view = new EditorView({
      doc: text,
      extensions: [
        basicSetup, keymap.of([indentWithTab]), StreamLanguage.define(lua), syntaxHighlighting(colors), theme,
        EditorView.contentAttributes.of({ "aria-label": "Lua script" }), EditorView.updateListener.of(update => update.docChanged && changed()),
      ],
    })
    element.replaceChildren(this.#view.dom)
  }
  get text() { return this.#view.state.doc.toString() }
  set text(text) { this.#view.dispatch({ changes: { from: 0, to: this.#view.state.doc.length, insert: text } }) }

  // Marks a line with a message; without one, removes the mark.
  mark(line, message) {
    const { doc } = this.#view.state, isMarked = message !== undefined && line >= 1 && line <= doc.lines
    const { from, to } = doc.line(isMarked ? line : 1)
    this.#view.dispatch(setDiagnostics(this.#view.state, isMarked ? [{ from, to, severity: "error", message }] : []))
  }
}
