#include "tests/usb/emulated_usb.h"

namespace rondure::testing {
namespace {

std::string byte(std::size_t value) { return std::string(1, static_cast<char>(value & 0xffU)); }
std::string word(std::size_t value) { return byte(value) + byte(value >> 8U); }

}  // namespace

std::string usb_descriptors(std::uint16_t vendor, std::uint16_t product,
                            const std::vector<DescribedInterface>& interfaces) {
  constexpr std::size_t kDevice = 1, kConfiguration = 2, kInterface = 4, kEndpoint = 5;
  std::string body;
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    const DescribedInterface& one = interfaces[i];
    body += byte(9) + byte(kInterface) + byte(i) + byte(0) + byte(one.endpoints.size()) +
            byte(one.device_class) + byte(one.subclass) + byte(one.protocol) + byte(0);
    for (const wire::UsbEndpoint& end : one.endpoints) {
      body += byte(7) + byte(kEndpoint) + byte(end.address) +
              byte(static_cast<std::size_t>(end.kind)) + word(end.packet_bytes) + byte(1);
    }
  }
  return byte(18) + byte(kDevice) + word(0x0200) + byte(0) + byte(0) + byte(0) + byte(64) +
         word(vendor) + word(product) + word(0x0100) + byte(1) + byte(2) + byte(3) + byte(1) +
         byte(9) + byte(kConfiguration) + word(9 + body.size()) + byte(interfaces.size()) +
         byte(1) + byte(0) + byte(0x80) + byte(50) + body;
}

}  // namespace rondure::testing
