"""Decoders of the files that Weald writes, one module a kind, for ../fingerprint.py."""
