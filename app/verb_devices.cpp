#include "app/device_text.h"
#include "app/terminal.h"
#include "app/verbs.h"

namespace rondure::app {

int devices(const DevicesArguments& arguments) {
  const auto plugged_in = wire::list_usb_devices();
  if (!plugged_in) {
    complain(plugged_in.error().error());
    return kBadInput;
  }
  const auto found = found_devices(*plugged_in, wire::list_serial_ports());
  say(arguments.json ? devices_json(found) : devices_text(found));
  return kAllWell;
}

}  // namespace rondure::app
