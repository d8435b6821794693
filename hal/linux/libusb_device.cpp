#include "hal/linux/libusb_device.hpp"

#include <fmt/format.h>
#include <libusb.h>

#include <array>
#include <bitset>

#include "hal/linux/libusb_error.hpp"
#include "hal/linux/libusb_pipe.hpp"

namespace forager::hal {
namespace {

struct CloseHandle {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};

std::string text_of(std::string_view operation, const UsbEndpointFacts& endpoint) {
  return fmt::format("{} endpoint 0x{:02x}", operation, endpoint.address);
}

// libusb only reads from the memory of what goes out.
unsigned char* memory_of(std::span<const std::byte> bytes) {
  return const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(bytes.data()));
}

class LibusbDevice final : public UsbDevice {
 public:
  LibusbDevice(std::shared_ptr<libusb_context> context, libusb_device_handle* handle, UsbDeviceFacts facts)
      : UsbDevice(std::move(facts)), context_(std::move(context)), handle_(handle) {}
  ~LibusbDevice() override;
  LibusbDevice(const LibusbDevice&) = delete;
  LibusbDevice& operator=(const LibusbDevice&) = delete;

 private:
  Result<> do_claim(std::uint8_t interface) override;
  Result<> do_release(std::uint8_t interface) override;
  Result<std::size_t> do_control_in(const UsbRequest& request, std::span<std::byte> into,
                                    Duration at_most) override {
    return control(request, true, into, at_most);
  }
  Result<> do_control_out(const UsbRequest& request, std::span<const std::byte> bytes,
                          Duration at_most) override {
    const auto sent = control(request, false, bytes, at_most);
    if (!sent) return fail(sent.error());
    return {};
  }
  Result<std::size_t> do_bulk_in(const UsbEndpointFacts& endpoint, std::span<std::byte> into,
                                 Duration at_most) override;
  Result<> do_bulk_out(const UsbEndpointFacts& endpoint, std::span<const std::byte> bytes,
                       Duration at_most) override;
  Result<> do_clear_halt(const UsbEndpointFacts& endpoint) override {
    return judge(libusb_clear_halt(handle_.get(), endpoint.address), text_of("clear halt of", endpoint));
  }
  Result<> do_start(const UsbEndpointFacts& endpoint, const UsbPipeConfig& config) override;
  Result<std::optional<std::size_t>> do_poll_in(const UsbEndpointFacts& endpoint,
                                                std::span<std::byte> into) override {
    return pipe(endpoint).poll_in(into);
  }
  Result<std::size_t> do_push_out(const UsbEndpointFacts& endpoint,
                                  std::span<const std::byte> bytes) override {
    return pipe(endpoint).push_out(bytes);
  }
  Result<> do_drain(const UsbEndpointFacts& endpoint, Duration at_most) override {
    return pipe(endpoint).drain(at_most);
  }
  void do_stop(const UsbEndpointFacts& endpoint) override { slot(endpoint).reset(); }

  Result<std::size_t> control(const UsbRequest& request, bool in, std::span<const std::byte> bytes,
                              Duration at_most);
  Result<> judge(int answer, std::string operation) const {
    if (answer < 0) return libusb_failure(name(), std::move(operation), answer);
    return {};
  }
  std::unique_ptr<LibusbPipe>& slot(const UsbEndpointFacts& endpoint) { return pipes_.at(endpoint.address); }
  LibusbPipe& pipe(const UsbEndpointFacts& endpoint) { return *slot(endpoint); }
  // One blocking transfer; bytes moved by then are in `moved` whatever the answer.
  int transfer(const UsbEndpointFacts& endpoint, unsigned char* memory, std::size_t size, int& moved,
               Duration at_most);

  std::shared_ptr<libusb_context> context_;
  std::unique_ptr<libusb_device_handle, CloseHandle> handle_;
  std::bitset<256> detached_;  // interfaces the kernel's driver had
  std::array<std::unique_ptr<LibusbPipe>, 256> pipes_;
};

// All interfaces are released before the first driver comes back: one driver may need several.
LibusbDevice::~LibusbDevice() {
  for (auto& pipe : pipes_) pipe.reset();
  for (const UsbInterfaceFacts& interface : facts().interfaces)
    if (claimed(interface.number)) libusb_release_interface(handle_.get(), interface.number);
  for (const UsbInterfaceFacts& interface : facts().interfaces)
    if (detached_.test(interface.number)) libusb_attach_kernel_driver(handle_.get(), interface.number);
}

Result<> LibusbDevice::do_claim(std::uint8_t interface) {
  const std::string operation = fmt::format("claim interface {}", interface);
  const bool driven = libusb_kernel_driver_active(handle_.get(), interface) == 1;
  if (driven) {
    const int answer = libusb_detach_kernel_driver(handle_.get(), interface);
    if (answer != LIBUSB_ERROR_NOT_FOUND) FORAGER_TRY(judge(answer, operation + " from the kernel's driver"));
    detached_.set(interface, answer == 0);
  }
  auto claimed_now = judge(libusb_claim_interface(handle_.get(), interface), operation);
  if (!claimed_now && detached_.test(interface)) {
    libusb_attach_kernel_driver(handle_.get(), interface);
    detached_.reset(interface);
  }
  return claimed_now;
}

Result<> LibusbDevice::do_release(std::uint8_t interface) {
  const std::string operation = fmt::format("release interface {}", interface);
  FORAGER_TRY(judge(libusb_release_interface(handle_.get(), interface), operation));
  if (!detached_.test(interface)) return {};
  detached_.reset(interface);
  return judge(libusb_attach_kernel_driver(handle_.get(), interface), operation + " to the kernel's driver");
}

Result<std::size_t> LibusbDevice::control(const UsbRequest& request, bool in,
                                          std::span<const std::byte> bytes, Duration at_most) {
  const int answer = libusb_control_transfer(
      handle_.get(), request.type(in), request.request, request.value, request.index, memory_of(bytes),
      static_cast<std::uint16_t>(bytes.size()), libusb_milliseconds(at_most));
  if (answer < 0)
    return libusb_failure(
        name(), fmt::format("request 0x{:02x} {}", request.request, in ? "to the host" : "from the host"),
        answer);
  return static_cast<std::size_t>(answer);
}

int LibusbDevice::transfer(const UsbEndpointFacts& endpoint, unsigned char* memory, std::size_t size,
                           int& moved, Duration at_most) {
  const auto call =
      endpoint.type == UsbTransferType::interrupt ? libusb_interrupt_transfer : libusb_bulk_transfer;
  return call(handle_.get(), endpoint.address, memory, static_cast<int>(size), &moved,
              libusb_milliseconds(at_most));
}

Result<std::size_t> LibusbDevice::do_bulk_in(const UsbEndpointFacts& endpoint, std::span<std::byte> into,
                                             Duration at_most) {
  int moved = 0;
  const int answer = transfer(endpoint, memory_of(into), into.size(), moved, at_most);
  if (answer < 0 && moved == 0) return libusb_failure(name(), text_of("read", endpoint), answer);
  return static_cast<std::size_t>(moved);
}

Result<> LibusbDevice::do_bulk_out(const UsbEndpointFacts& endpoint, std::span<const std::byte> bytes,
                                   Duration at_most) {
  int moved = 0;
  const int answer = transfer(endpoint, memory_of(bytes), bytes.size(), moved, at_most);
  if (answer < 0)
    return libusb_failure(
        name(), fmt::format("{}: {} of {} bytes went", text_of("write", endpoint), moved, bytes.size()),
        answer);
  return {};
}

Result<> LibusbDevice::do_start(const UsbEndpointFacts& endpoint, const UsbPipeConfig& config) {
  auto made =
      std::make_unique<LibusbPipe>(context_.get(), handle_.get(), std::string(name()), endpoint, config);
  FORAGER_TRY(made->start());
  slot(endpoint) = std::move(made);
  return {};
}

}  // namespace

std::unique_ptr<UsbDevice> make_libusb_device(std::shared_ptr<libusb_context> context,
                                              libusb_device_handle* handle, UsbDeviceFacts facts) {
  return std::make_unique<LibusbDevice>(std::move(context), handle, std::move(facts));
}

}  // namespace forager::hal
