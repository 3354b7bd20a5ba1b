#include "command.h"

int main(int argc, char** argv) {
  return odis::app::runCommandLine(argc, argv);
}
