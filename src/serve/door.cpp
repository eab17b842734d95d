// SPDX-License-Identifier: GPL-3.0-or-later
#include "door.hpp"

namespace stylet::serve {

std::shared_ptr<const void> Door::enter(const std::string& address) {
  {
    const std::lock_guard lock(count_->mutex);
    std::size_t& here = count_->of_address[address];
    if (count_->all >= most_ || here >= most_per_address_) {
      if (here == 0) count_->of_address.erase(address);
      return nullptr;
    }
    ++count_->all;
    ++here;
  }
  return {this, [count = count_, address](const void* /*door*/) {
            const std::lock_guard lock(count->mutex);
            --count->all;
            if (--count->of_address[address] == 0) count->of_address.erase(address);
          }};
}

std::size_t Door::open() const {
  const std::lock_guard lock(count_->mutex);
  return count_->all;
}

}  // namespace stylet::serve
