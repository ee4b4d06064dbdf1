#include "pour/device_watch.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bin_scenes {

void DeviceWatch::begin_world(WorldId world) {
  world_ = world;
  watch_->set_rules(world, rules_);
  rest_anew_ = energy_anew_ = true;
  states_ = true;
}

void DeviceWatch::leave_world() {
  if (!energy_anew_) merge(timed(watch_->energy(world_)));
}

void DeviceWatch::restart() {
  times_.assign(1, 0.0);
  rested_ = 0;
  rest_anew_ = energy_anew_ = true;
  observed_ = current_ = false;
  earlier_ = {};
}

std::uint32_t DeviceWatch::first_younger_than(double age) const {
  const auto old = [&](double time) { return times_.back() - time >= age; };
  return static_cast<std::uint32_t>(std::partition_point(times_.begin() + 1, times_.end(), old) - times_.begin());
}

void DeviceWatch::ask(double time, const Ages& ages, bool driven, bool states) {
  BIN_SCENES_ASSERT(time >= times_.back());
  WatchAsk ask;
  ask.seconds = time - times_.back();
  times_.push_back(time);
  ages_ = ages;
  ask.observation = static_cast<std::uint32_t>(times_.size() - 1);
  ask.rest_anew = std::exchange(rest_anew_, false);
  ask.energy_anew = std::exchange(energy_anew_, false);
  ask.driven = driven;
  ask.states = asked_states_ = states;
  for (std::size_t k = 0; k < ages.size(); ++k) ask.since[k] = first_younger_than(ages[k]);
  rested_ = first_younger_than(window_ * (1.0 - 1e-9)) - 1;  // as RestWatch::observe()
  ask.rested = rested_;
  watch_->ask(world_, ask);
  asked_ = true;
  states_ = false;
}

void DeviceWatch::ask_nothing(bool states) {
  WatchAsk ask;
  ask.rest_anew = rest_anew_;
  ask.energy_anew = std::exchange(energy_anew_, false);  // of before these steps
  ask.states = asked_states_ = states;
  watch_->ask(world_, ask);
  asked_ = false;
  states_ = false;
}

void DeviceWatch::take() {
  current_ = std::exchange(asked_, false);
  observed_ = observed_ || current_;
  states_ = states_ || seen().states;
}

std::size_t DeviceWatch::moved(double age) const {
  for (std::size_t k = 0; k < ages_.size(); ++k)
    if (std::abs(ages_[k] - age) <= 1e-9) return seen().moved[k];
  BIN_SCENES_ASSERT(!"an age that was not asked for");
  return 0;
}

double DeviceWatch::still(std::size_t body) const {
  const std::uint32_t moved = watch_->bodies(world_)[body].moved;
  return moved == 0 || moved >= times_.size() ? 0.0 : times_.back() - times_[moved];
}

bool DeviceWatch::resting(std::size_t body) const {
  const std::uint32_t moved = watch_->bodies(world_)[body].moved;
  return observed_ && moved > 0 && moved <= rested_;
}

WatchedEnergy DeviceWatch::timed(WatchedEnergy energy) const {
  for (double* time : {&energy.parts.time, &energy.parts.thrown.time, &energy.all.time}) {
    const auto number = static_cast<std::size_t>(*time);
    *time = number < times_.size() ? times_[number] : 0.0;
  }
  return energy;
}

void DeviceWatch::merge(WatchedEnergy energy) {
  const EnergyReport::Thrown thrown =
      energy.parts.thrown.ratio > earlier_.parts.thrown.ratio ? energy.parts.thrown : earlier_.parts.thrown;
  if (energy.parts.gain > earlier_.parts.gain) earlier_.parts = energy.parts;
  earlier_.parts.thrown = thrown;
  if (energy.all.relative > earlier_.all.relative) earlier_.all = energy.all;
}

EnergyReport DeviceWatch::energy() const {
  DeviceWatch all = *this;
  if (!energy_anew_) all.merge(timed(watch_->energy(world_)));
  return all.earlier_.parts;
}

WorstReport::EnergyGain DeviceWatch::energy_of_all() const {
  DeviceWatch all = *this;
  if (!energy_anew_) all.merge(timed(watch_->energy(world_)));
  return all.earlier_.all;
}

}  // namespace bin_scenes
