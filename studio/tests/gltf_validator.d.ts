/** The package comes without types. */
declare module 'gltf-validator' {
  export function validateBytes(bytes: Uint8Array): Promise<{ issues: { messages: object[] } }>;
}
