#include "bridge/zmq/operations/arguments.h"
#include "bridge/zmq/operations/operation.h"
#include "bridge/zmq/request.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gloam::bridge::zeromq;
  const auto request = parse_request({data, size});
  if (!request.ok()) {
    (void)error_reply({}, request.error());
    return 0;
  }
  const auto operation = find_operation(request->operation);
  if (!operation.ok()) {
    (void)error_reply(request->id, operation.error());
    return 0;
  }
  const auto arguments = Arguments::check(request->arguments, (*operation)->arguments);
  if (!arguments.ok()) return 0;
  for (const Argument& argument : (*operation)->arguments) {
    if (!arguments->has(argument.name)) continue;
    switch (argument.type) {
      case ArgumentType::kInteger:
        (void)arguments->integer(argument.name);
        break;
      case ArgumentType::kNumber:
        (void)arguments->number(argument.name);
        break;
      case ArgumentType::kText:
        (void)arguments->text(argument.name);
        break;
      case ArgumentType::kBool:
        (void)arguments->flag(argument.name);
        break;
      case ArgumentType::kNumbers:
        (void)arguments->numbers(argument.name);
        break;
      case ArgumentType::kTexts:
        (void)arguments->texts(argument.name);
        break;
      case ArgumentType::kBytes:
        (void)arguments->bytes(argument.name);
        break;
      case ArgumentType::kNumberMap:
        (void)arguments->number_map(argument.name);
        break;
      case ArgumentType::kNumbersMap:
        (void)arguments->numbers_map(argument.name);
        break;
      case ArgumentType::kTextMap:
        (void)arguments->text_map(argument.name);
        break;
    }
  }
  return 0;
}
