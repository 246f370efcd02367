// What is made once and kept for the next time, with a bound.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

namespace rangepose {

/// By key, the `most` that were used last. Those that somebody holds live on after they are
/// dropped. For one thread at a time.
template <typename Key, typename T>
class Kept {
 public:
  explicit Kept(std::size_t most) : most_(std::max<std::size_t>(most, 1)) {}

  /// What `make()` gave when it was last asked for this key.
  template <typename Make>
  std::shared_ptr<T> of(const Key& key, const Make& make) {
    auto found = entries_.find(key);
    if (found == entries_.end()) {
      auto made = std::make_shared<T>(make());
      if (entries_.size() >= most_) entries_.erase(oldest());
      found = entries_.emplace(key, Entry{std::move(made), 0}).first;
    }
    found->second.used = ++now_;
    return found->second.value;
  }

  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::shared_ptr<T> value;
    std::uint64_t used;
  };
  auto oldest() const {
    return std::min_element(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) {
      return a.second.used < b.second.used;
    });
  }

  std::size_t most_;
  std::uint64_t now_ = 0;
  std::map<Key, Entry> entries_;
};

}  // namespace rangepose
