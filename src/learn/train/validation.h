// The figure that counts: the variance of the real estimator, predicted on scenes that nothing was learned
// from.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "odis/models/direction_model.h"

namespace odis::learn {

// Of each view of these shards the variance of a guided sample over that of an unguided one: the mixture of
// BSDF and map, beside next-event estimation with multiple importance sampling, over all bounces, with the
// selection probabilities that are best. Maps are made from all pilots of the view but the last, and judged
// by the vertices of the last. Returns the geometric mean; 1 if there is no view. Throws ShardError.
double predictedVariance(const std::vector<std::string>& shardFiles,
                         const std::shared_ptr<const core::DirectionModel>& model);

}  // namespace odis::learn
