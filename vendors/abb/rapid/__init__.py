"""RAPID, the language of ABB controllers: reader, writer and patcher."""
