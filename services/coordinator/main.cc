#include "services/coordinator/program.h"

int main(int argc, char** argv) { return dispersa::RunCoordinator(argc, argv); }
