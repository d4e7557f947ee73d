// Faces of volumes leave nothing but counts in the stencil.
void main() {}
