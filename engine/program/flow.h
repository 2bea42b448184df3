/// The largest flow through a graph, and the cut where it is full. Internal.
#ifndef GLINT_PROGRAM_FLOW_H
#define GLINT_PROGRAM_FLOW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GLINT_FLOW_SOURCE 0u ///< nodes
#define GLINT_FLOW_SINK 1u
#define GLINT_FLOW_ENDLESS 1000000u ///< of edges that no cut goes through

typedef struct glint_flow_edge {
    uint32_t to, room; ///< how much more may flow there
    uint32_t next; ///< of the edges from the same node, plus 1; 0: none
} glint_flow_edge;

typedef struct glint_flow {
    glint_flow_edge *edges; ///< in pairs, the second of which goes back
    uint32_t edge_count;
    uint32_t *from; ///< the first edge from each node, plus 1
    uint32_t *queue;
    uint32_t *way; ///< the edge by which each node was met, plus 1; 0: it was not
    uint32_t node_count;
} glint_flow;

/// Room for so many nodes and edges. False: no memory; it is destroyed by the caller all the same.
bool glint_flow_create(glint_flow *flow, size_t node_count, size_t edge_count);
void glint_flow_destroy(glint_flow *flow);
void glint_flow_add(glint_flow *flow, uint32_t from, uint32_t to, uint32_t room);
/// Returns the largest flow, or one above `limit` where that is larger; and marks the nodes near the sink: from there on to it nothing
/// is full. Between that and the rest is the minimal cut that is nearest to the sink.
uint32_t glint_flow_fill(glint_flow *flow, uint32_t limit);
bool glint_flow_near_sink(const glint_flow *flow, uint32_t node);

#endif
