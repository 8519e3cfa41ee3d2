#include "reference/integrate/shards.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <optional>
#include <set>

#include "reference/base/error.hpp"

namespace plumbline::integrate {
namespace {

struct ShardNumber {
  int index = 0;
  int count = 0;
};

ShardNumber shard_of(const image::LayeredImage& part, const std::string& name) {
  const auto text = part.attributes.find(kShardAttribute);
  ShardNumber shard;
  const bool is_shard = text != part.attributes.end() &&
                        std::sscanf(text->second.c_str(), "%d/%d", &shard.index, &shard.count) == 2 &&
                        shard.count >= 1 && shard.index >= 0 && shard.index < shard.count;
  if (!is_shard) throw InputError(name + ": is not a shard written by `render --shard`");
  return shard;
}

// What may differ between the parts of one render.
std::map<std::string, std::string> common_attributes(const image::LayeredImage& part) {
  std::map<std::string, std::string> kept = part.attributes;
  for (const char* own : {kShardAttribute, "plumbline.command", "plumbline.seconds"}) kept.erase(own);
  return kept;
}

void require_same_render(const image::LayeredImage& part, const std::string& name,
                         const image::LayeredImage& first, const std::string& first_name) {
  if (part.width != first.width || part.height != first.height) {
    throw InputError(fmt::format("{}: is {}x{}, but {} is {}x{}", name, part.width, part.height, first_name,
                                 first.width, first.height));
  }
  const auto own = common_attributes(part);
  const auto other = common_attributes(first);
  for (const auto& [key, value] : other) {
    const auto found = own.find(key);
    const std::string here = found == own.end() ? "nothing" : found->second;
    if (here != value) {
      throw InputError(fmt::format("{}: {} is {}, but {} has {}", name, key, here, first_name, value));
    }
  }
  for (const auto& [channel, values] : first.channels) {
    if (!part.channels.contains(channel))
      throw InputError(fmt::format("{}: lacks the channel {}", name, channel));
  }
  if (part.channels.size() != first.channels.size() || own.size() != other.size()) {
    throw InputError(fmt::format("{}: has other layers or attributes than {}", name, first_name));
  }
}

}  // namespace

image::LayeredImage merge_shards(const std::vector<image::LayeredImage>& parts,
                                 const std::vector<std::string>& names) {
  if (parts.empty()) throw InputError("merge: nothing to merge");
  image::LayeredImage merged = parts.front();
  merged.attributes.erase(kShardAttribute);
  const int count = shard_of(parts.front(), names.front()).count;
  std::set<int> seen;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const image::LayeredImage& part = parts[i];
    const ShardNumber shard = shard_of(part, names[i]);
    if (shard.count != count) {
      throw InputError(
          fmt::format("{}: is one of {} shards, {} is one of {}", names[i], shard.count, names[0], count));
    }
    if (!seen.insert(shard.index).second) {
      throw InputError(fmt::format("{}: shard {}/{} comes twice", names[i], shard.index, count));
    }
    require_same_render(part, names[i], parts.front(), names.front());
    const auto samples = part.channels.find("samples");
    if (samples == part.channels.end()) throw InputError(names[i] + ": has no samples layer");
    for (auto& [channel, values] : merged.channels) {
      const std::vector<float>& own = part.channels.at(channel);
      for (std::size_t p = 0; p < values.size(); ++p) {
        if (samples->second[p] > 0.0F) values[p] = own[p];
      }
    }
  }
  for (int index = 0; index < count; ++index) {
    if (!seen.contains(index)) {
      throw InputError(
          fmt::format("{}: is one of {} shards, but {}/{} is missing", names[0], count, index, count));
    }
  }
  return merged;
}

}  // namespace plumbline::integrate
