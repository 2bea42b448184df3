/// Maximum flow by shortest augmenting paths (J. Edmonds and R. M. Karp, 1972).
#include "engine/render/program/flow.h"

#include <stdlib.h>
#include <string.h>

bool glint_flow_create(glint_flow *flow, size_t node_count, size_t edge_count)
{
    *flow = (glint_flow) { .node_count = (uint32_t)node_count };
    flow->edges = malloc(2 * edge_count * sizeof *flow->edges);
    flow->from = calloc(node_count, sizeof *flow->from);
    flow->queue = malloc(node_count * sizeof *flow->queue);
    flow->next_edge = malloc(node_count * sizeof *flow->next_edge);
    return flow->edges && flow->from && flow->queue && flow->next_edge;
}

void glint_flow_destroy(glint_flow *flow)
{
    free(flow->edges);
    free(flow->from);
    free(flow->queue);
    free(flow->next_edge);
}

static void add(glint_flow *flow, uint32_t from, uint32_t to, uint32_t residual)
{
    flow->edges[flow->edge_count] = (glint_flow_edge) { to, residual, flow->from[from] };
    flow->from[from] = ++flow->edge_count;
}

void glint_flow_add(glint_flow *flow, uint32_t from, uint32_t to, uint32_t residual)
{
    add(flow, from, to, residual);
    add(flow, to, from, 0);
}

/// Searches backwards from the sink along edges with capacity left. Stores the first edge of each node's path to the
/// sink. Returns whether there is a path from the source.
static bool find_path(glint_flow *flow)
{
    uint32_t count = 0;
    memset(flow->next_edge, 0, flow->node_count * sizeof *flow->next_edge);
    flow->queue[count++] = GLINT_FLOW_SINK;
    for (uint32_t at = 0; at < count; at++)
        for (uint32_t e = flow->from[flow->queue[at]]; e; e = flow->edges[e - 1].next) {
            const uint32_t node = flow->edges[e - 1].to, step = ((e - 1) ^ 1) + 1;
            if (node == GLINT_FLOW_SINK || flow->next_edge[node] || !flow->edges[step - 1].residual)
                continue;
            flow->next_edge[node] = step;
            flow->queue[count++] = node;
        }
    return flow->next_edge[GLINT_FLOW_SOURCE];
}

/// Fills the augmenting path from the source. Returns the flow that was added.
static uint32_t fill_path(glint_flow *flow)
{
    uint32_t residual = UINT32_MAX, node = GLINT_FLOW_SOURCE;
    for (; node != GLINT_FLOW_SINK; node = flow->edges[flow->next_edge[node] - 1].to)
        residual = residual < flow->edges[flow->next_edge[node] - 1].residual
                       ? residual
                       : flow->edges[flow->next_edge[node] - 1].residual;
    for (node = GLINT_FLOW_SOURCE; node != GLINT_FLOW_SINK; node = flow->edges[flow->next_edge[node] - 1].to) {
        flow->edges[flow->next_edge[node] - 1].residual -= residual;
        flow->edges[(flow->next_edge[node] - 1) ^ 1].residual += residual;
    }
    return residual;
}

uint32_t glint_flow_fill(glint_flow *flow, uint32_t limit)
{
    uint32_t flowing = 0;
    while (flowing <= limit && find_path(flow))
        flowing += fill_path(flow);
    return flowing;
}

bool glint_flow_near_sink(const glint_flow *flow, uint32_t node)
{
    return node == GLINT_FLOW_SINK || flow->next_edge[node];
}
