#include "services/cli/program.h"

int main(int argc, char** argv) { return dispersa::RunProgram(argc, argv); }
