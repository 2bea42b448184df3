local s = gr.sphere('s') s:set_material(gr.material({0.6, 0.4, 0.2}, {0, 0, 0}, 0))
  gr.render(s, 'ball', 16, 16, {0, 0, 4}, {0, 0, -1}, {0, 1, 0}, 50, {1, 1, 1}, {})