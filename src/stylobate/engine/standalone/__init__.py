"""Single runs in the language of the compiler, which compute in a page without Python."""
