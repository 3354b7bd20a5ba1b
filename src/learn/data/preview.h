// Pictures of what a shard says of some of its targets, next to what the pilots see there.
#pragma once

#include "learn/data/make_shard.h"
#include "learn/scenes/canvas.h"

namespace odis::learn {

// A row for each of `count` targets, spread evenly over shards, views and their targets: the view with the
// target's place in red; for the cell around it, what the pilots' vertices say arrives times |cos|; the
// same of the reference; then the reference's maps, and what each group of lights gives. Throws ShardError.
Canvas previewOf(const std::vector<std::string>& shards, int count);

}  // namespace odis::learn
