-- A model of the first generation: it sets a global.
wedge = gr.mesh('wedge', {
  {-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {"-1", 1.5, -1}, {1, 1.5, -1},
}, {
  {0, 1, 2, 3}, {3, 2, 5, 4}, {1, 0, 4, 5}, {0, 3, 4}, {2, 1, 5},
})
