/// Maximum flow and minimum cut of a graph. Internal.
#ifndef GLINT_PROGRAM_FLOW_H
#define GLINT_PROGRAM_FLOW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GLINT_FLOW_SOURCE 0u ///< node numbers
#define GLINT_FLOW_SINK 1u
#define GLINT_FLOW_ENDLESS 1000000u ///< capacity of edges that no cut may cross

typedef struct glint_flow_edge {
    uint32_t to, residual; ///< the node that the edge leads to; residual: its remaining capacity
    uint32_t next; ///< index of the next edge from the same node, plus 1; 0: none
} glint_flow_edge;

typedef struct glint_flow {
    glint_flow_edge *edges; ///< edges in pairs: each edge is followed by its reverse
    uint32_t edge_count;
    uint32_t *from; ///< index of the first edge from each node, plus 1
    uint32_t *queue;
    uint32_t *next_edge; ///< index of the first edge of each node's path to the sink, plus 1; 0: there is no such path
    uint32_t node_count;
} glint_flow;

/// Reserves space for this number of nodes and edges. False: out of memory; the caller must still destroy the flow.
bool glint_flow_create(glint_flow *flow, size_t node_count, size_t edge_count);
void glint_flow_destroy(glint_flow *flow);
void glint_flow_add(glint_flow *flow, uint32_t from, uint32_t to, uint32_t residual);
/// Returns the maximum flow, or a value above `limit` when the maximum is larger. Marks the nodes from which the sink
/// can still be reached along edges with capacity left: they are the sink's side of the minimum cut nearest to the
/// sink.
uint32_t glint_flow_fill(glint_flow *flow, uint32_t limit);
bool glint_flow_near_sink(const glint_flow *flow, uint32_t node);

#endif
