#include "tests/kernel/gpio_sim.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <utility>

#include "tests/kernel/sysfs.hpp"

namespace forager::kernel {
namespace {

// Folders of configfs are objects of the kernel: made and removed one by one.
std::string make_folder(std::string path) {
  ::mkdir(path.c_str(), 0755);
  return path;
}

}  // namespace

GpioSim::GpioSim(std::string label, const std::vector<Line>& lines) : lines_(lines) {
  static int made = 0;
  folder_ = make_folder("/sys/kernel/config/gpio-sim/chip" + std::to_string(made++));
  const std::string bank = make_folder(folder_ + "/bank");
  put(bank + "/label", label);
  put(bank + "/num_lines", std::to_string(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string line = make_folder(bank + "/line" + std::to_string(i));
    if (!lines[i].name.empty()) put(line + "/name", lines[i].name);
    if (lines[i].held_by.empty()) continue;
    make_folder(line + "/hog");
    put(line + "/hog/name", lines[i].held_by);
    put(line + "/hog/direction", "output-low");
  }
  plug_in();
}

GpioSim::~GpioSim() {
  if (live_) unplug();
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const std::string line = folder_ + "/bank/line" + std::to_string(i);
    if (!lines_[i].held_by.empty()) ::rmdir((line + "/hog").c_str());
    ::rmdir(line.c_str());
  }
  ::rmdir((folder_ + "/bank").c_str());
  ::rmdir(folder_.c_str());
}

void GpioSim::plug_in() {
  live_ = put(folder_ + "/live", "1");
  chip_ = get(folder_ + "/bank/chip_name");
  pins_ = "/sys/devices/platform/" + get(folder_ + "/dev_name") + "/" + chip_;
}

void GpioSim::unplug() {
  put(folder_ + "/live", "0");
  live_ = false;
}

std::string GpioSim::pin(unsigned line, const char* attribute) const {
  return pins_ + "/sim_gpio" + std::to_string(line) + "/" + attribute;
}

bool GpioSim::level(unsigned line) const { return get(pin(line, "value")) == "1"; }

void GpioSim::drive(unsigned line, bool high) const {
  put(pin(line, "pull"), high ? "pull-up" : "pull-down");
}

}  // namespace forager::kernel
