#include "ui/damage/damage_history.h"

namespace octascope::ui {

void DamageHistory::forget() {
  for (Entry& entry : entries_)
    entry.image = 0;
  unknown_ = true;
}

const DamageHistory::Entry* DamageHistory::find(std::uint64_t image) const {
  const Entry& entry = entries_[image % kept];
  return entry.image == image ? &entry : nullptr;
}

void DamageHistory::add(const hal::BackBuffer& buffer, Damage& damage) {
  if (unknown_)
    damage.add_everything();
  if (buffer.image == 0) {
    forget();
    damage.add_everything();
    return;
  }
  unknown_ = false;
  Entry& entry = entries_[buffer.image % kept];
  const bool again = entry.image == buffer.image && entry.damage.width() == damage.width() &&
                     entry.damage.height() == damage.height();
  if (again)
    entry.damage.add(damage);
  else
    entry.damage = damage;
  entry.image = buffer.image;
  if (buffer.holds == 0 || buffer.holds >= buffer.image) {
    damage.add_everything();
    entry.damage.add_everything(); // so that the other buffers get all of the next images, too
    return;
  }
  for (std::uint64_t image = buffer.holds + 1; image <= buffer.image; ++image) {
    const Entry* const lacked = buffer.image - image < kept ? find(image) : nullptr;
    if (lacked == nullptr || lacked->damage.width() != damage.width() ||
        lacked->damage.height() != damage.height()) {
      damage.add_everything();
      return;
    }
    damage.add(lacked->damage);
  }
}

} // namespace octascope::ui
